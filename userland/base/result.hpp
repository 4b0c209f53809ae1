// SPDX-License-Identifier: GPL-2.0-or-later
// Result<T>: the one result type at I/O edges. An Error says what is wrong, where, and what to do.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace phantom {

/// What a user reads when something cannot be done: one line.
struct Error {
    std::string where;    ///< file, "file:line", "file: face 12" or a device node; may be empty
    std::string what;     ///< what is wrong and what was expected
    std::string remedy{}; ///< what to do, e.g. an option that helps; may be empty

    /// "where: what (remedy)"
    [[nodiscard]] std::string text() const
    {
        std::string line = where.empty() ? what : where + ": " + what;
        if (!remedy.empty())
            line += " (" + remedy + ")";
        return line;
    }
};

/// A value or an Error. Result<void> is Result<std::monostate>.
template <typename T>
class [[nodiscard]] Result {
  public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

    [[nodiscard]] bool ok() const { return state_.index() == 0; }
    explicit operator bool() const { return ok(); }

    /// The value; only when ok().
    T& value() & { return std::get<0>(state_); }
    const T& value() const& { return std::get<0>(state_); }
    T&& value() && { return std::get<0>(std::move(state_)); }
    T& operator*() & { return value(); }
    const T& operator*() const& { return value(); }
    T&& operator*() && { return std::move(*this).value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }

    /// The error; only when not ok().
    [[nodiscard]] const Error& error() const { return std::get<1>(state_); }

  private:
    std::variant<T, Error> state_;
};

using Status = Result<std::monostate>;
inline Status success()
{
    return Status(std::monostate{});
}

} // namespace phantom
