// SPDX-License-Identifier: GPL-2.0-or-later
// Height fields against Keys' bicubic convolution (1981, with a = -1/2 the same surface as Catmull and
// Rom's), and images as files have them, sound and damaged.
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>
#include <png.h>

#include "folder.hpp"
#include "mesh/prepare.hpp"
#include "mesh/vector.hpp"
#include "scene/shapes/grey_image.hpp"
#include "shape_checks.hpp"

namespace phantom::scene::test {
namespace {

using mesh::Vec3;

using Samples = std::vector<std::vector<unsigned>>; ///< rows from the upper edge, 0 ... 65535

Samples hills(std::size_t width, std::size_t height)
{
    Samples rows(height, std::vector<unsigned>(width));
    for (std::size_t r = 0; r < height; ++r)
        for (std::size_t c = 0; c < width; ++c)
            rows[r][c] = static_cast<unsigned>(32768 + 20000 * std::sin(0.9 * static_cast<double>(c)) *
                                                           std::cos(0.7 * static_cast<double>(r)));
    return rows;
}

std::string pgm_of(const Samples& rows, bool text = false)
{
    std::string out = (text ? "P2\n# hills\n" : "P5\n# hills\n") + std::to_string(rows[0].size()) + " " +
                      std::to_string(rows.size()) + "\n65535\n";
    for (const auto& row : rows) {
        for (const unsigned sample : row) {
            if (text)
                out += std::to_string(sample) + " ";
            else
                out += {static_cast<char>(sample >> 8), static_cast<char>(sample & 255)};
        }
    }
    return out;
}

/// A PNG file through libpng's simple interface.
void write_png(const std::filesystem::path& file, const Samples& rows, png_uint_32 format)
{
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(rows[0].size());
    image.height = static_cast<png_uint_32>(rows.size());
    image.format = format;
    std::vector<std::uint8_t> bytes;
    std::vector<std::uint16_t> words;
    for (const auto& row : rows) {
        for (const unsigned sample : row) {
            for (png_uint_32 i = 0; i < PNG_IMAGE_SAMPLE_CHANNELS(format); ++i) {
                bytes.push_back(static_cast<std::uint8_t>(sample >> 8));
                words.push_back(static_cast<std::uint16_t>(sample));
            }
        }
    }
    const void* pixels = format & PNG_FORMAT_FLAG_LINEAR ? static_cast<const void*>(words.data())
                                                         : static_cast<const void*>(bytes.data());
    ASSERT_TRUE(png_image_write_to_file(&image, file.c_str(), 0, pixels, 0, nullptr)) << image.message;
}

double kernel(double x)
{
    x = std::abs(x);
    return x < 1 ? (1.5 * x - 2.5) * x * x + 1 : x < 2 ? ((-0.5 * x + 2.5) * x - 4) * x + 2 : 0;
}
double kernel_slope(double x)
{
    const double a = std::abs(x), s = x < 0 ? -1 : 1;
    return s * (a < 1 ? (4.5 * a - 5) * a : a < 2 ? (-1.5 * a + 5) * a - 4 : 0);
}

/// The surface over [0, columns - 1] x [0, rows - 1], in parts of white.
struct Keys {
    const Samples& rows;
    [[nodiscard]] double sample(long c, long r) const
    {
        const long last_c = static_cast<long>(rows[0].size()) - 1,
                   last_r = static_cast<long>(rows.size()) - 1;
        if (c < 0 || c > last_c) {
            const long edge = c < 0 ? 0 : last_c;
            return 2 * sample(edge, r) - sample(edge + (c < 0 ? 1 : -1), r);
        }
        if (r < 0 || r > last_r) {
            const long edge = r < 0 ? 0 : last_r;
            return 2 * sample(c, edge) - sample(c, edge + (r < 0 ? 1 : -1));
        }
        return rows[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)] / 65535.0;
    }
    template <typename U, typename V>
    [[nodiscard]] double sum(double u, double v, U&& in_u, V&& in_v) const
    {
        const long c0 = static_cast<long>(std::floor(u)), r0 = static_cast<long>(std::floor(v));
        double total = 0;
        for (long r = r0 - 1; r <= r0 + 2; ++r)
            for (long c = c0 - 1; c <= c0 + 2; ++c)
                total += sample(c, r) * in_u(u - static_cast<double>(c)) * in_v(v - static_cast<double>(r));
        return total;
    }
};

/// The relief of an image over size_x by size_y mm, white at height mm. Its distance is measured upright.
Formula relief_formula(const Samples& rows, double size_x, double size_y, double height)
{
    const double cells_u = static_cast<double>(rows[0].size()) - 1,
                 cells_v = static_cast<double>(rows.size()) - 1;
    const auto u = [=](const Vec3& p) { return (p[0] / size_x + 0.5) * cells_u; };
    const auto v = [=](const Vec3& p) { return (0.5 - p[1] / size_y) * cells_v; };
    return {[=, &rows](const Vec3& p) {
                return std::abs(p[2] - height * Keys{rows}.sum(u(p), v(p), kernel, kernel));
            },
            [=, &rows](const Vec3& p, const Vec3&) {
                const double zu = height * Keys{rows}.sum(u(p), v(p), kernel_slope, kernel);
                const double zv = height * Keys{rows}.sum(u(p), v(p), kernel, kernel_slope);
                return mesh::normalized({-zu * cells_u / size_x, zv * cells_v / size_y, 1});
            },
            [=, &rows](double s, double t) {
                return Vec3{(s - 0.5) * size_x, (0.5 - t) * size_y,
                            height * Keys{rows}.sum(s * cells_u, t * cells_v, kernel, kernel)};
            }};
}

TEST(SceneHeightField, OpenFieldIsTheBicubicSurfaceWithinItsChordError)
{
    const Folder folder;
    const Samples rows = hills(9, 7);
    const Formula formula = relief_formula(rows, 80, 50, 20);
    const HeightField field{folder.write("hills.pgm", pgm_of(rows)), {80, 50}, 20, 0, false};
    for (const double chord_mm : {1.0, 0.05}) {
        const mesh::Soup soup = soup_of(field, chord_mm);
        expect_sound(soup, false);
        expect_exact_corners(soup, formula, 80);
        EXPECT_GT(expect_within_chord(soup, formula, chord_mm), 0.1 * chord_mm);
    }
}

TEST(SceneHeightField, WithoutAChordErrorItsCornersAreItsSamples)
{
    const Folder folder;
    const Samples rows = hills(30, 20);
    const HeightField field{folder.write("hills.pgm", pgm_of(rows)), {80, 50}, 20, 0, false};
    const mesh::Soup soup = soup_of(field);
    ASSERT_EQ(soup.vertices.size(), 600U);
    EXPECT_EQ(soup.faces.size(), 2U * 29 * 19);
    EXPECT_EQ(soup.vertices[0][0], -40);
    EXPECT_EQ(soup.vertices[0][1], 25) << "the image's upper edge lies at +y";
    EXPECT_NEAR(soup.vertices[0][2], 20 * rows[0][0] / 65535.0, 1e-12);
    EXPECT_NEAR(soup.vertices[599][2], 20 * rows[19][29] / 65535.0, 1e-12);
}

TEST(SceneHeightField, ClosedFieldHasFlatWallsAndABottom)
{
    const Folder folder;
    // Rugged: black and white side by side, also on the edges.
    Samples rows(12, std::vector<unsigned>(40));
    for (std::size_t r = 0; r < 12; ++r)
        for (std::size_t c = 0; c < 40; ++c)
            rows[r][c] = (r * 7 + c * 5) % 3 == 0 ? 65535 : 0;
    const HeightField field{folder.write("rugged.pgm", pgm_of(rows)), {80, 30}, 20, 5, true};
    const mesh::Soup soup = soup_of(field);
    // Between black and white the slope is beyond what one quad can follow: 32 corners get other normals.
    expect_sound(soup, true, 32);
    const auto prepared = mesh::prepare(soup, {}, "field");
    ASSERT_TRUE(prepared.ok());
    EXPECT_NEAR(prepared->report.size_mm[2], 25, 1e-12);
    std::size_t walls = 0;
    double bottom = 0, area = 0;
    for (std::size_t f = 0; f < soup.faces.size(); ++f) {
        const auto& [a, b, c] = soup.faces[f];
        const Vec3 n = mesh::scaled(mesh::cross(mesh::subtract(soup.vertices[b], soup.vertices[a]),
                                                mesh::subtract(soup.vertices[c], soup.vertices[a])),
                                    0.5);
        area += n[2];
        bottom += n[2] < -1e-9 ? -n[2] : 0;
        walls += std::abs(n[2]) < 1e-9;
    }
    EXPECT_NEAR(bottom, 80 * 30, 1e-9);
    EXPECT_NEAR(area, 0, 1e-9);
    EXPECT_EQ(walls, 4U * (39 + 11) + 2U * (39 + 11) + 2U * (16 + 6));
}

TEST(SceneHeightField, SwingsBelowTheBottomAreRefused)
{
    const Folder folder;
    Samples rows(6, std::vector<unsigned>(6, 0));
    rows[2][2] = rows[2][3] = rows[3][2] = rows[3][3] = 65535;
    const HeightField field{folder.write("peak.pgm", pgm_of(rows)), {50, 50}, 20, 0.5, true};
    const auto soup = triangulate(field, 0.05);
    ASSERT_FALSE(soup.ok());
    EXPECT_EQ(soup.error().where, "base_mm");
}

TEST(SceneHeightField, EveryKindOfImageGivesTheSameHeights)
{
    const Folder folder;
    const Samples rows = hills(5, 4);
    const auto check = [&](const std::filesystem::path& file, double tolerance) {
        const auto image = read_grey_image(file);
        ASSERT_TRUE(image.ok()) << image.error().text();
        ASSERT_EQ(image->width, 5U);
        ASSERT_EQ(image->height, 4U);
        for (std::uint32_t r = 0; r < 4; ++r)
            for (std::uint32_t c = 0; c < 5; ++c)
                EXPECT_NEAR(image->at(c, r), rows[r][c] / 65535.0, tolerance);
    };
    check(folder.write("a.pgm", pgm_of(rows)), 1e-15);
    check(folder.write("b.pgm", pgm_of(rows, true)), 1e-15);
    write_png(folder.path() / "c.png", rows, PNG_FORMAT_LINEAR_Y);
    check(folder.path() / "c.png", 1e-15);
    write_png(folder.path() / "d.png", rows, PNG_FORMAT_GRAY);
    check(folder.path() / "d.png", 1.0 / 255);
    check(folder.write(
              "e.pgm", "P5 5 4 255\n" +
                           [&] {
                               std::string bytes;
                               for (const auto& row : rows)
                                   for (const unsigned sample : row)
                                       bytes += static_cast<char>(sample >> 8);
                               return bytes;
                           }()),
          1.0 / 255);
}

TEST(SceneHeightField, DamagedImagesAreToldInOneLine)
{
    const Folder folder;
    const Samples rows = hills(5, 4);
    const auto error_of = [&](const std::string& bytes) {
        const auto image = read_grey_image(folder.write("a.img", bytes));
        if (image.ok())
            return std::string();
        const std::string text = image.error().text();
        EXPECT_EQ(text.find('\n'), std::string::npos) << text;
        EXPECT_EQ(text.find(folder.path().string()), 0U) << text;
        return text.substr(folder.path().string().size() + 8);
    };
    write_png(folder.path() / "c.png", rows, PNG_FORMAT_LINEAR_Y);
    std::ifstream stream(folder.path() / "c.png", std::ios::binary);
    const std::string png((std::istreambuf_iterator<char>(stream)), {}), pgm = pgm_of(rows);
    ASSERT_EQ(error_of(png), "");
    // Whole but for the bytes after the last sample's, which nothing needs.
    for (std::size_t size = 1; size + 12 < png.size(); ++size)
        EXPECT_NE(error_of(png.substr(0, size)), "") << "cut to " << size;
    for (std::size_t size = 1; size < pgm.size(); ++size)
        EXPECT_NE(error_of(pgm.substr(0, size)), "") << "cut to " << size;
    // A changed byte breaks a checksum, or is an error of its own.
    for (std::size_t at = 8; at < png.size(); ++at) {
        std::string bad = png;
        bad[at] = static_cast<char>(bad[at] ^ 0x55);
        (void)error_of(bad);
    }
    EXPECT_EQ(error_of("GIF89a"), "is neither a PNG nor a PGM file (P2, P5)");
    EXPECT_EQ(error_of(""), "is empty");
    EXPECT_EQ(error_of("P5 5 4 65535\nabc"), "is a damaged PGM file: it ends early (truncated)");
    EXPECT_EQ(error_of("P5 1 4 255\nabcd"), "has 1 x 4 samples, expected 2 ... 30000 on a side");
    EXPECT_EQ(error_of("P2 2 2 9\n1 2 3 10"), "is a damaged PGM file: sample 3 is no number of 0 ... 9");
    EXPECT_EQ(error_of("P5 2 2 99999\nabcd"),
              "is a damaged PGM file: expected width, height and a largest value up to 65535");
    write_png(folder.path() / "rgb.png", rows, PNG_FORMAT_RGB);
    const auto colours = read_grey_image(folder.path() / "rgb.png");
    ASSERT_FALSE(colours.ok());
    EXPECT_NE(colours.error().text().find("expected one grey channel"), std::string::npos);
    EXPECT_NE(read_grey_image("/nonexistent/a.png").error().text().find("no such file"), std::string::npos);
}

TEST(SceneHeightField, TooManySamplesAreTheImagesFault)
{
    const Folder folder;
    const std::string black(3000UL * 3000, '\0');
    const HeightField field{folder.write("large.pgm", "P5 3000 3000 255\n" + black), {50, 50}, 20, 5, true};
    const auto soup = triangulate(field, std::nullopt);
    ASSERT_FALSE(soup.ok());
    EXPECT_EQ(soup.error().where, "image");
    EXPECT_NE(soup.error().what.find("3000 x 3000 samples"), std::string::npos);
}

} // namespace
} // namespace phantom::scene::test
