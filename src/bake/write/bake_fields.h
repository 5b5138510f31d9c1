// The options and the statistics of a bake, field by field, as bake.json has them.
#pragma once

#include "bake/write/json_fields.h"
#include "lobelia/bake.h"

namespace lobelia {

inline constexpr std::array k_switch_names = {"off", "on"};
inline constexpr std::array k_frame_names = {"tangent", "world"};
inline constexpr std::array k_layout_names = {"automatic", "shared", "packed"};
inline constexpr std::array k_direction_names = {"uniform", "mixture"};
inline constexpr std::array k_shard_names = {"tiles", "samples"};
inline constexpr std::uint64_t k_any_u32 = 0xffffffff, k_any_u64 = ~std::uint64_t{0};

void fields(auto& archive, AtlasOptions& options) {
    archive.number("texels_per_metre", options.texels_per_metre);
    archive.whole("padding", options.padding, 0, 65536);
    archive.choice("layout", options.layout, k_layout_names);
}

void fields(auto& archive, PathOptions& options) {
    archive.whole("bounces", options.bounces, 0, 1u << 20);
    archive.whole("seed", options.seed, 0, k_any_u32);
    archive.choice("next_event", options.next_event, k_switch_names);
    archive.choice("environment_table", options.environment_table, k_switch_names);
    archive.choice("roulette", options.roulette, k_switch_names);
    archive.choice("sun_size", options.sun_size, k_switch_names);
}

void fields(auto& archive, Shard& shard) {
    archive.choice("by", shard.by, k_shard_names);
    archive.whole("index", shard.index, 0, k_any_u32);
    archive.whole("count", shard.count, 1, k_any_u32);
}

/// Codec, frame and the pages' size stand elsewhere in the manifest; what does not change the result stands nowhere.
void fields(auto& archive, BakeOptions& options) {
    archive.whole("samples", options.samples, 0, k_any_u32);
    archive.whole("samples_per_pass", options.samples_per_pass, 0, k_any_u32);
    archive.number("most_seconds", options.most_seconds);
    archive.number("target_error", options.target_error);
    archive.choice("directions", options.directions, k_direction_names);
    archive.choice("push_out", options.push_out, k_switch_names);
    archive.text("only_object", options.only_object);
    archive.group("paths", options.paths);
    archive.group("atlas", options.atlas);
    archive.group("shard", options.shard);
}

void fields(auto& archive, BakeStatistics& statistics) {
    archive.whole("texels", statistics.texels, 0, k_any_u64);
    archive.whole("invalid_texels", statistics.invalid_texels, 0, k_any_u64);
    archive.whole("buried_texels", statistics.buried_texels, 0, k_any_u64);
    archive.whole("rays", statistics.rays, 0, k_any_u64);
    archive.number("seconds", statistics.seconds);
    archive.whole("samples", statistics.samples, 0, k_any_u32);
    archive.number("mean_error", statistics.mean_error);
    archive.number("back_face_share", statistics.back_face_share);
    archive.number("negative_share", statistics.negative_share);
    archive.number("ringing", statistics.ringing);
    archive.number("codec_error", statistics.codec_error);
}

}  // namespace lobelia
