// The files of a bake's folder as one input: for each file the index of its name, its size, its bytes.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>

namespace lobelia {

/// The names that a bundle can hold. Append only: seeds refer to them by index.
inline constexpr std::array k_bundle_names{"bake.json",       "page-0.exr",          "page-1.exr",
                                           "probes.json",     "probes.bin",          "scene.glb",
                                           "environment.exr", "checkpoint/job.json", "checkpoint/region-0000.state"};

/// The files of that name in a folder, one after another.
inline std::string bundle_of(const std::filesystem::path& folder) {
    std::string bundle;
    for (std::size_t i = 0; i < k_bundle_names.size(); ++i) {
        std::ifstream file(folder / k_bundle_names[i], std::ios::binary);
        if (!file) continue;
        const std::string bytes{std::istreambuf_iterator<char>(file), {}};
        const auto size = static_cast<std::uint32_t>(bytes.size());
        bundle += static_cast<char>(i);
        bundle.append(reinterpret_cast<const char*>(&size), sizeof size);
        bundle += bytes;
    }
    return bundle;
}

/// Calls write(name, bytes) for each file of any bytes taken as a bundle.
template <class Write>
void unbundle(std::span<const std::byte> bundle, const Write& write) {
    std::uint32_t size = 0;
    while (bundle.size() > sizeof size) {
        const char* const name = k_bundle_names[static_cast<std::size_t>(bundle[0]) % k_bundle_names.size()];
        std::memcpy(&size, bundle.data() + 1, sizeof size);
        bundle = bundle.subspan(1 + sizeof size);
        const std::size_t taken = std::min<std::size_t>(size, bundle.size());
        write(name, bundle.first(taken));
        bundle = bundle.subspan(taken);
    }
}

}  // namespace lobelia
