// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/peers/hulls.hpp"

#include <algorithm>
#include <new>
#include <span>
#include <string>

#include "fdh/coherent.hpp"
#include "fdh/tree.hpp"

namespace phantom::peers {

namespace {

/// Triangles up to which every variant runs; beyond, FDH14 without SSE2, and FDH6, to save memory.
constexpr std::size_t others_up_to = 3'000'000;

struct AlignedDelete {
    void operator()(std::byte* bytes) const
    {
        ::operator delete[](bytes, std::align_val_t{fdh::image_alignment});
    }
};
using AlignedBytes = std::unique_ptr<std::byte[], AlignedDelete>;

AlignedBytes copy_of(std::span<const std::byte> bytes)
{
    AlignedBytes copy(static_cast<std::byte*>(
        ::operator new[](std::max<std::size_t>(1, bytes.size()), std::align_val_t{fdh::image_alignment})));
    std::copy(bytes.begin(), bytes.end(), copy.get());
    return copy;
}

/// The same tree in memory of its own.
template <int K>
std::optional<fdh::TriangleTree<K>> copy_of(const fdh::TriangleTree<K>& tree, fdh::Isa isa)
{
    const fdh::TreeImage image = tree.image();
    auto kept =
        std::make_shared<std::pair<AlignedBytes, AlignedBytes>>(copy_of(image.nodes), copy_of(image.leaves));
    fdh::TreeImage copy = image;
    copy.nodes = {kept->first.get(), image.nodes.size()};
    copy.leaves = {kept->second.get(), image.leaves.size()};
    return fdh::TriangleTree<K>::open(copy, kept, isa);
}

template <int K>
std::string hulls()
{
    return "FDH" + std::to_string(K);
}

/// A query through the tree as it is.
template <int K>
class Stateless : public Contender {
  public:
    [[nodiscard]] std::string name() const override { return hulls<K>(); }
    [[nodiscard]] std::string method() const override { return "TriangleTree::nearest"; }
    void prepare(const Mesh& mesh) override
    {
        tree_.reset();
        mesh_ = &mesh;
    }
    void build(unsigned threads) override
    {
        tree_.reset();
        tree_ = fdh::TriangleTree<K>::build(mesh_->view(), {.threads = threads});
    }
    [[nodiscard]] bool builds_parallel() const override { return true; }
    [[nodiscard]] std::size_t bytes() const override { return tree_->bytes(); }
    void query(const fdh::Point& p, double radius) override { tree_->nearest(p, wanted, radius, found_); }
    void distances(std::vector<double>& out) const override
    {
        out.clear();
        for (const fdh::Hit& hit : found_.hits)
            out.push_back(hit.distance);
    }
    [[nodiscard]] std::optional<double> leaves() const override
    {
        return static_cast<double>(found_.counts.leaves);
    }

    [[nodiscard]] bool refits() const override { return true; }
    [[nodiscard]] bool refits_parallel() const override { return true; }
    void prepare_refit(const Mesh& moved, unsigned threads) override
    {
        moved_ = &moved;
        refit_threads_ = threads;
    }
    void refit() override { tree_ = tree_->refitted(moved_->view(), {.threads = refit_threads_}); }

    [[nodiscard]] const fdh::TriangleTree<K>& tree() const { return *tree_; }

  protected:
    const Mesh* mesh_ = nullptr;
    const Mesh* moved_ = nullptr;
    unsigned refit_threads_ = 1;
    std::optional<fdh::TriangleTree<K>> tree_;
    fdh::Nearest found_;
};

/// A copy of another contender's tree, queried with a given instruction set. A copy, because whoever comes
/// second in a round would find the first one's cache lines.
template <int K>
class WithIsa : public Stateless<K> {
  public:
    /// The source outlives this contender.
    WithIsa(const Stateless<K>& source, fdh::Isa isa) : source_(source), isa_(isa) {}
    [[nodiscard]] std::string name() const override { return hulls<K>() + suffix(); }
    [[nodiscard]] bool refits() const override { return false; }
    void build(unsigned /*threads*/) override { this->tree_ = copy_of(source_.tree(), isa_); }
    [[nodiscard]] bool builds() const override { return false; }

  protected:
    [[nodiscard]] std::string suffix() const
    {
        return isa_ == fdh::Isa::best ? "" : std::string(" ") + fdh::isa_name(isa_);
    }

  private:
    const Stateless<K>& source_;
    fdh::Isa isa_;
};

/// The same with memory of the queries before.
template <int K>
class Coherent final : public WithIsa<K> {
  public:
    using WithIsa<K>::WithIsa;
    [[nodiscard]] std::string name() const override { return hulls<K>() + " coherent" + this->suffix(); }
    [[nodiscard]] std::string method() const override { return "CoherentQuery::nearest"; }
    void query(const fdh::Point& p, double radius) override
    {
        coherent_.nearest(*this->tree_, p, wanted, radius, this->found_);
    }
    /// Most queries look at no leaf of the tree.
    [[nodiscard]] std::optional<double> leaves() const override { return std::nullopt; }

  private:
    fdh::CoherentQuery<K> coherent_;
};

} // namespace

std::vector<std::unique_ptr<Contender>> own_contenders(const Mesh& mesh)
{
    std::vector<std::unique_ptr<Contender>> all;
    auto own = std::make_unique<Stateless<14>>();
    const Stateless<14>& source = *own;
    all.push_back(std::move(own));
    all.push_back(std::make_unique<Coherent<14>>(source, fdh::Isa::best));
    const bool small = mesh.triangles.size() <= others_up_to;
    for (const fdh::Isa isa : {fdh::Isa::avx2, fdh::Isa::sse2}) {
        if (!fdh::isa_available(isa) || fdh::resolve_isa(fdh::Isa::best) == isa)
            continue;
        if (small || isa == fdh::Isa::avx2) {
            all.push_back(std::make_unique<WithIsa<14>>(source, isa));
            all.push_back(std::make_unique<Coherent<14>>(source, isa));
        }
    }
    all.push_back(std::make_unique<Stateless<6>>());
    if (small) {
        all.push_back(std::make_unique<Stateless<18>>());
        all.push_back(std::make_unique<Stateless<26>>());
    }
    return all;
}

} // namespace phantom::peers
