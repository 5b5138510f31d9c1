// The result of a function whose input may be bad: a value, or an error that names file, place and remedy.
#pragma once

#include <string>
#include <utility>
#include <variant>

#include "lobelia/contract.h"

namespace lobelia {

/// The reason why bad input was refused: one or two sentences for a person, naming the file and the place in it.
struct Error {
    /// stopped: the caller's stop flag ended the work; there is nothing to mend.
    enum class Kind { refused, stopped };
    std::string message;
    Kind kind = Kind::refused;
};

/// A `T` or an `Error`. To read the value of a failure, or the error of a success, violates the contract (contract.h).
template <class T>
class [[nodiscard]] Result {
  public:
    Result(T value) : content_(std::move(value)) {}      // NOLINT(google-explicit-constructor): `return value;`
    Result(Error error) : content_(std::move(error)) {}  // NOLINT(google-explicit-constructor): `return Error{...};`

    [[nodiscard]] explicit operator bool() const { return content_.index() == 0; }
    [[nodiscard]] const Error& error() const {
        if (*this) [[unlikely]]
            contract_violated("error() of a success");
        return *std::get_if<1>(&content_);
    }
    [[nodiscard]] T& value() & {
        check_success();
        return *std::get_if<0>(&content_);
    }
    [[nodiscard]] const T& value() const& {
        check_success();
        return *std::get_if<0>(&content_);
    }
    [[nodiscard]] T&& value() && {
        check_success();
        return std::move(*std::get_if<0>(&content_));
    }
    [[nodiscard]] T& operator*() & { return value(); }
    [[nodiscard]] const T& operator*() const& { return value(); }
    [[nodiscard]] T&& operator*() && { return std::move(*this).value(); }
    [[nodiscard]] T* operator->() { return &value(); }
    [[nodiscard]] const T* operator->() const { return &value(); }

  private:
    void check_success() const {
        if (!*this) [[unlikely]]
            contract_violated("value() of a failure: " + error().message);
    }

    std::variant<T, Error> content_;
};

/// The result of a function that only succeeds or fails.
struct Done {};
using Status = Result<Done>;

}  // namespace lobelia
