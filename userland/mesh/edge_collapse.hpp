// SPDX-License-Identifier: GPL-2.0-or-later
// Simplification by collapsing edges with least quadric error (Garland and Heckbert 1997, "Surface
// Simplification Using Quadric Error Metrics"), in doubles: fine scans have details of a hundred-thousandth
// of their size, which quadrics in floats do not see.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mesh/wedges.hpp"

namespace phantom::mesh {

/// Squared distances from weighted planes (or lines), summed, as a function of place.
struct Quadric {
    std::array<double, 6> a{}; ///< xx xy xz yy yz zz
    std::array<double, 3> b{};
    double c = 0, weight = 0;

    void add_plane(const Vec3& point, const Vec3& unit_normal, double weight_);
    void add_line(const Vec3& point, const Vec3& unit_direction, double weight_);
    void add(const Quadric& other);
    /// Mean of the squared distances, mm^2; never below zero.
    [[nodiscard]] double mean_at(const Vec3& point) const;
};

/// A half-edge collapse moves a vertex onto a neighbour, and the two faces between them vanish. Vertices stay
/// where they are, so what is left is part of what was there, bit for bit. No collapse
///   - changes the topology (the link condition: Dey, Edelsbrunner, Guha and Nekhayev 1999): what was closed
///     and without edges of more than two faces stays so, nothing is pinched off or glued together,
///   - takes a vertex off a border or a crease, or moves one where more than two of these meet or one ends,
///   - turns a face by more than 75 degrees, or makes a face thinner than a twentieth of an equilateral
///     one (twice the root of three times area over the squared sides' sum) when none there was.
class EdgeCollapse {
  public:
    /// threads: 0 all cores; the result is the same for any number.
    explicit EdgeCollapse(Wedges wedges, unsigned threads = 0);

    /// Collapses what costs no more than error_mm, least first, until only `faces` are left or nothing
    /// can be collapsed. The error is the root mean square of the distances from the planes of all faces that
    /// went into the vertex since the beginning; on borders and creases from their lines as well.
    void run(double error_mm, std::size_t faces);
    /// What half of all vertices could be collapsed for now, mm; nothing when there is none.
    [[nodiscard]] std::optional<double> median_error_mm() const;
    [[nodiscard]] const Wedges& wedges() const { return wedges_; }

  private:
    /// A neighbour of a vertex and the edge there.
    struct Spoke {
        std::uint32_t vertex = no_neighbour;
        std::uint32_t outs = 0, ins = 0;          ///< faces with the edge running from the middle, and to it
        std::uint32_t after_out = no_neighbour;   ///< third corner of the face with the edge running out,
        std::uint32_t before_in = no_neighbour;   ///< and of the one with it running in
        std::array<std::uint32_t, 2> out{}, in{}; ///< wedges (middle, neighbour) of those faces
        std::uint8_t out_group = 0, in_group = 0; ///< of those faces
        /// No border, no crease, and no border of two groups of faces, which is kept as a crease is.
        [[nodiscard]] bool plain() const
        {
            return outs == 1 && ins == 1 && out == in && out_group == in_group;
        }
    };
    /// What is round a vertex; empty for one that stays out of it.
    struct Ring {
        std::vector<Spoke> spokes;
        std::size_t faces = 0;
        [[nodiscard]] const Spoke* to(std::uint32_t vertex) const;
    };
    struct Corner {
        Triple vertex, wedge;
        std::uint8_t group = 0;
    };
    struct Candidate {
        double cost; ///< mm^2
        std::uint32_t from, to;
    };
    /// Scratch of one thread.
    struct Workspace {
        Ring from, to;
        std::vector<Candidate> choices;
    };

    [[nodiscard]] Vec3 place(std::uint32_t vertex) const; ///< seen from centre_
    void begin_pass();
    void end_pass(); ///< vanished faces, vertices and wedges go
    [[nodiscard]] std::span<const std::uint32_t> faces_of(std::uint32_t vertex) const;
    /// A face as the pass has made it, the vertex first; corners no_neighbour when it has vanished.
    [[nodiscard]] Corner corner_now(std::uint32_t face, std::uint32_t vertex) const;
    void look_round(std::uint32_t vertex, Ring& ring) const;
    [[nodiscard]] static bool single_fan(const Ring& ring);
    /// Borders and creases that go through the vertex: 0 or 2; nothing when it has to stay where it is.
    [[nodiscard]] static std::optional<int> features(const Ring& ring);
    [[nodiscard]] double cost(std::uint32_t from, std::uint32_t to, bool feature) const;
    [[nodiscard]] bool keeps_topology(std::uint32_t to, int features, const Workspace& work) const;
    [[nodiscard]] bool keeps_shape(std::uint32_t from, std::uint32_t to) const;
    /// The cheapest collapse of the vertex that is allowed.
    [[nodiscard]] std::optional<Candidate> best(std::uint32_t vertex, double cost_max, Workspace& work) const;
    [[nodiscard]] std::vector<Candidate> candidates(double cost_max) const;
    /// How many faces it removed; none where it is not allowed, or no longer.
    std::size_t apply(const Candidate& collapse, Workspace& work);

    Wedges wedges_;
    unsigned threads_;
    Vec3 centre_{};
    std::vector<Quadric> planes_, lines_; ///< per vertex; lines_ of the borders and creases through it
    std::vector<std::uint32_t> first_, faces_of_; ///< faces of vertex v: faces_of_[first_[v]] ...
    // Of one pass: a vertex that took part in a collapse takes part in no other, so what is known of it
    // holds.
    std::vector<std::uint32_t> vertex_now_, wedge_now_;
    std::vector<bool> taken_;
};

} // namespace phantom::mesh
