// SPDX-License-Identifier: GPL-2.0-or-later
// Arrays that are not changed any more.
#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace phantom {

/// An array without writers. Copies share the elements: they are a vector's that was given away, or lie in
/// memory that `keeper` keeps alive (a mapped file).
template <typename T>
class SharedArray {
  public:
    using value_type = T;

    SharedArray() = default;
    // Implicit: what was built as a vector becomes the array by assignment.
    SharedArray(std::vector<T> elements) // NOLINT(google-explicit-constructor)
    {
        auto owner = std::make_shared<const std::vector<T>>(std::move(elements));
        elements_ = *owner;
        keeper_ = std::move(owner);
    }
    SharedArray(std::initializer_list<T> elements) : SharedArray(std::vector<T>(elements)) {}
    SharedArray(std::span<const T> elements, std::shared_ptr<const void> keeper)
        : elements_(elements), keeper_(std::move(keeper))
    {
    }

    [[nodiscard]] std::size_t size() const { return elements_.size(); }
    [[nodiscard]] bool empty() const { return elements_.empty(); }
    [[nodiscard]] const T* data() const { return elements_.data(); }
    [[nodiscard]] auto begin() const { return elements_.begin(); }
    [[nodiscard]] auto end() const { return elements_.end(); }
    [[nodiscard]] const T& front() const { return elements_.front(); }
    [[nodiscard]] const T& back() const { return elements_.back(); }
    const T& operator[](std::size_t index) const { return elements_[index]; }
    operator std::span<const T>() const { return elements_; } // NOLINT(google-explicit-constructor)

    [[nodiscard]] std::vector<T> to_vector() const { return {begin(), end()}; }

    friend bool operator==(const SharedArray& a, const SharedArray& b)
    {
        return std::equal(a.begin(), a.end(), b.begin(), b.end());
    }

  private:
    std::span<const T> elements_;
    std::shared_ptr<const void> keeper_;
};

} // namespace phantom
