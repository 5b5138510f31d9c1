// Options in one form for all verbs. Includes CLI11: for source files of verbs only.
#pragma once

#include <CLI/CLI.hpp>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace lobelia::cli {

/// A check that a number lies in [low, high]; unlike CLI::Range it refuses NaN.
[[nodiscard]] CLI::Validator number_in(double low, double high);

/// Adds -o, --out; `what` names the file or the folder. An empty `out` has no default: a file is required unless the
/// verb can do without.
inline CLI::Option* add_out_option(CLI::App& command, std::string& out, const std::string& what) {
    CLI::Option* option = command.add_option("-o,--out", out, what);
    return out.empty() ? option : option->capture_default_str();
}

template <class Enum>
using EnumNames = std::initializer_list<std::pair<const char*, Enum>>;

/// Adds an option whose values are given by name; the name of the present value is the default.
template <class Enum>
CLI::Option* add_enum_option(CLI::App& command, const std::string& option_name, Enum& value, EnumNames<Enum> names,
                             const std::string& description) {
    std::vector<std::pair<std::string, Enum>> known(names.begin(), names.end());
    std::vector<std::string> choices;
    std::string present;
    for (const auto& [name, entry] : known) {
        choices.push_back(name);
        if (entry == value) present = name;
    }
    const auto assign = [&value, known](const std::string& text) {
        for (const auto& [name, entry] : known)
            if (name == text) value = entry;
    };
    return command.add_option_function<std::string>(option_name, assign, description)
        ->check(CLI::IsMember(choices))
        ->default_str(present);
}

}  // namespace lobelia::cli
