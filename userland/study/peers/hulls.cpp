// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/peers/hulls.hpp"

#include <algorithm>
#include <new>
#include <span>
#include <string>

#include "fdh/tree.hpp"

namespace phantom::peers {

namespace {

/// Triangles up to which every variant runs; beyond, FDH14, its AVX2 and FDH6, to save memory.
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

/// A query through the tree as it is.
template <int K>
class Stateless : public Contender {
  public:
    [[nodiscard]] std::string name() const override { return "FDH" + std::to_string(K); }
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

    [[nodiscard]] const fdh::TriangleTree<K>& tree() const { return *tree_; }

  protected:
    const Mesh* mesh_ = nullptr;
    std::optional<fdh::TriangleTree<K>> tree_;
    fdh::Nearest found_;
};

/// A copy of another contender's tree, queried with a given instruction set. A copy, because whoever comes
/// second in a round would find the first one's cache lines.
template <int K>
class WithIsa final : public Stateless<K> {
  public:
    /// The source outlives this contender.
    WithIsa(const Stateless<K>& source, fdh::Isa isa) : source_(source), isa_(isa) {}
    [[nodiscard]] std::string name() const override
    {
        return Stateless<K>::name() + " " + fdh::isa_name(isa_);
    }
    void build(unsigned /*threads*/) override { this->tree_ = copy_of(source_.tree(), isa_); }
    [[nodiscard]] bool builds() const override { return false; }

  private:
    const Stateless<K>& source_;
    fdh::Isa isa_;
};

} // namespace

std::vector<std::unique_ptr<Contender>> own_contenders(const Mesh& mesh)
{
    std::vector<std::unique_ptr<Contender>> all;
    auto own = std::make_unique<Stateless<14>>();
    const Stateless<14>& source = *own;
    all.push_back(std::move(own));
    const bool small = mesh.triangles.size() <= others_up_to;
    for (const fdh::Isa isa : {fdh::Isa::avx2, fdh::Isa::sse2})
        if (fdh::isa_available(isa) && fdh::resolve_isa(fdh::Isa::best) != isa &&
            (small || isa == fdh::Isa::avx2))
            all.push_back(std::make_unique<WithIsa<14>>(source, isa));
    all.push_back(std::make_unique<Stateless<6>>());
    if (small) {
        all.push_back(std::make_unique<Stateless<18>>());
        all.push_back(std::make_unique<Stateless<26>>());
    }
    return all;
}

} // namespace phantom::peers
