// The handler of violated contracts.
#include "lobelia/contract.h"

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace lobelia {
namespace {

/// Of the whole process, as std::set_terminate's: a violation may occur on any thread.
std::atomic<ContractHandler> current_handler = nullptr;

}  // namespace

std::string ContractViolation::str() const {
    const std::string_view path = place.file;
    const std::string_view file = path.substr(path.find_last_of('/') + 1);
    return std::string(file) + ":" + std::to_string(place.line) + ": " + place.function + ": " + message;
}

ContractHandler set_contract_handler(ContractHandler handler) { return current_handler.exchange(handler); }

void contract_violated(std::string message, SourcePlace place) {
    const ContractViolation violation{place, std::move(message)};
    if (const ContractHandler handler = current_handler.load())
        handler(violation);
    else
        std::fprintf(stderr, "lobelia: %s\n", violation.str().c_str());
    std::abort();
}

void count_violated(const char* what, std::size_t found, std::size_t lowest, std::size_t highest, SourcePlace place) {
    std::string message(what);
    message.append(": ").append(std::to_string(found)).append(", must be ").append(std::to_string(lowest));
    if (highest != lowest) message.append(" to ").append(std::to_string(highest));
    contract_violated(std::move(message), place);
}

}  // namespace lobelia
