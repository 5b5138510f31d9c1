// Preconditions: checks of what callers pass, and what happens when one fails. docs/conventions.md has the rules.
#pragma once

#include <cstddef>
#include <string>

/// Whether checks that cost time in inner loops are compiled in: indices of single entries, bounds of parts. By default
/// in debug builds; -DLOBELIA_ASSERTIONS=1 (the CMake option of that name) turns them on in any build.
#if !defined(LOBELIA_ASSERTIONS)
#if defined(NDEBUG)
#define LOBELIA_ASSERTIONS 0
#else
#define LOBELIA_ASSERTIONS 1
#endif
#endif

namespace lobelia {

/// The place in the library's source where a check stands; as a default argument, that of the caller.
struct SourcePlace {
    const char* file;
    const char* function;
    int line;
    [[nodiscard]] static constexpr SourcePlace here(const char* in_file = __builtin_FILE(),
                                                    const char* in_function = __builtin_FUNCTION(),
                                                    int at_line = __builtin_LINE()) {
        return {in_file, in_function, at_line};
    }
};

/// A precondition that a caller did not meet.
struct ContractViolation {
    SourcePlace place;
    std::string message;  ///< the value found and the one required, such as "coefficients: 8, must be 9"

    /// "moments.cpp:62: merge: floats of the other state: 30, must be 36".
    [[nodiscard]] std::string str() const;
};

/// Receives a violation, on the thread of the call and before that call has read or written anything. It may throw: the
/// exception leaves the library's function, and objects remain as they were. If it returns, the program is aborted.
using ContractHandler = void (*)(const ContractViolation& violation);

/// Sets the handler of the whole process and returns the one before. Null, the default, prints the violation to stderr.
ContractHandler set_contract_handler(ContractHandler handler);

/// Calls the handler, then aborts.
[[noreturn]] void contract_violated(std::string message, SourcePlace place = SourcePlace::here());

/// Reports a count outside [lowest, highest].
[[noreturn]] void count_violated(const char* what, std::size_t found, std::size_t lowest, std::size_t highest,
                                 SourcePlace place);

/// Compares a count with the one required; kept in release builds.
inline void check_equal(const char* what, std::size_t found, std::size_t required,
                        SourcePlace place = SourcePlace::here()) {
    if (found != required) [[unlikely]]
        count_violated(what, found, required, required, place);
}

/// The same for a count in [lowest, highest].
inline void check_range(const char* what, std::size_t found, std::size_t lowest, std::size_t highest,
                        SourcePlace place = SourcePlace::here()) {
    if (found < lowest || found > highest) [[unlikely]]
        count_violated(what, found, lowest, highest, place);
}

}  // namespace lobelia

/// A check that LOBELIA_ASSERTIONS turns on. Expands to nothing, and evaluates nothing, where that is 0.
#if LOBELIA_ASSERTIONS
#define LOBELIA_ASSERT(condition) \
    ((condition) ? static_cast<void>(0) : ::lobelia::contract_violated("must hold: " #condition))
#define LOBELIA_ASSERT_BELOW(what, found, size) \
    ::lobelia::check_range(what, found, 0, static_cast<std::size_t>(size) - 1)
#else
#define LOBELIA_ASSERT(condition) static_cast<void>(0)
#define LOBELIA_ASSERT_BELOW(what, found, size) static_cast<void>(0)
#endif
