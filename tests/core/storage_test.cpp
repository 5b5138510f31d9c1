// Tests every storage with all kinds of compatible coefficients: its bound holds and is not stated much too large, and
// its layout stores each channel of each coefficient exactly once.
#include "lobelia/storage.h"

#include <set>

#include "core/storage/layout_text.h"
#include "lobelia/codec.h"
#include "support.h"

namespace lobelia {
namespace {

/// Coefficients of a page of texels, as planes.
class LightmapPage {
  public:
    LightmapPage(std::size_t width, std::size_t height, std::size_t coefficients)
        : width_(width), height_(height), values_(3 * coefficients, std::vector<float>(width * height)) {}
    [[nodiscard]] std::vector<float>& operator[](std::size_t plane) { return values_[plane]; }
    [[nodiscard]] const std::vector<float>& operator[](std::size_t plane) const { return values_[plane]; }
    [[nodiscard]] std::size_t planes() const { return values_.size(); }
    [[nodiscard]] std::size_t size() const { return width_ * height_; }
    [[nodiscard]] CoefficientPlanes view() const {
        return {width_, height_, std::span<const std::vector<float>>(values_), values_.size() / 3};
    }
    [[nodiscard]] MutableCoefficientPlanes view() {
        return {width_, height_, std::span<std::vector<float>>(values_), values_.size() / 3};
    }
    [[nodiscard]] LightmapPage through(const TextureLayout& layout) const {
        LightmapPage back(width_, height_, values_.size() / 3);
        unpack(layout, pack(layout, view()), back.view());
        return back;
    }

  private:
    std::size_t width_, height_;
    std::vector<std::vector<float>> values_;
};

/// Coefficient traits of all codecs, by name.
std::vector<std::pair<std::string, CoefficientTraits>> all_traits() {
    std::vector<std::pair<std::string, CoefficientTraits>> result;
    std::set<std::tuple<std::size_t, bool, bool, std::vector<float>>> seen;
    for (const auto& basis_name : basis_names())
        for (const char* encoder_name : {"moments", "nnls"}) {
            const auto encoder = make_encoder(encoder_name, make_basis(basis_name).value());
            if (!encoder) continue;  // NNLS supports some bases only
            const auto t = coefficient_traits(**encoder);
            if (t.count <= 25 && seen.emplace(t.count, t.non_negative, t.colours, t.lead_bounds).second)
                result.emplace_back(basis_name + "/" + encoder_name, t);
        }
    return result;
}

enum class Texture { smooth, noisy };

TEST(SharedExponents, KeepTheirBoundWhereTheLargestComponentIsAboutToDouble) {
    // The largest value lies a little below a power of two, the others at every position between two steps.
    const CoefficientTraits traits{1, true, true, {}};
    for (const char* name : {"rgb9e5", "rgbe"}) {
        const Storage& storage = *find_storage(name).value();
        LightmapPage page(64, 64, 1), allowed = page;
        for (std::size_t i = 0; i < page.size(); ++i) {
            page[0][i] = 2 - 0x1p-13f * static_cast<float>(i % 64);
            page[1][i] = 1 + 0x1p-13f * static_cast<float>(i / 64);
            page[2][i] = 0x1p-14f * static_cast<float>(i);
        }
        const LightmapPage back = page.through(storage.layout(traits));
        allowed_error(storage, traits, std::as_const(page).view(), allowed.view());
        double used = 0;
        for (std::size_t p = 0; p < 3; ++p)
            for (std::size_t i = 0; i < page.size(); ++i)
                used = std::max(used, std::abs(static_cast<double>(back[p][i]) - page[p][i]) / allowed[p][i]);
        EXPECT_LE(used, 1 + 1e-6) << name;
        EXPECT_GE(used, 0.98) << name;
    }
}

/// Coefficients that obey the traits, over many magnitudes, often at the edge of what is allowed.
LightmapPage random_page(const CoefficientTraits& traits, std::size_t width, std::size_t height, std::uint32_t seed,
                         Texture texture) {
    std::mt19937 generator(seed);
    const auto uniform = [&] { return static_cast<float>(generator()) * 0x1p-32f; };
    LightmapPage page(width, height, traits.count);
    for (std::size_t p = 0; p < page.planes(); ++p) {
        const float phase = 6 * uniform(), slope = 0.1f + 0.2f * uniform();
        for (std::size_t i = 0; i < page.size(); ++i) {
            const float x = static_cast<float>(i % width), y = static_cast<float>(i / width);
            // Noise over ten octaves, with extremes, or waves of a tenth of a texel.
            float v = std::sin(slope * (x + 0.7f * y) + phase);
            if (texture == Texture::noisy)
                v = (generator() % 4 == 0 ? 1 : uniform()) * (generator() % 2 ? 1.0f : -1.0f);
            const bool lead = !traits.lead_bounds.empty() && p < 3;
            const bool ratio = !traits.lead_bounds.empty() && p >= 3;
            if (traits.non_negative || lead) v = texture == Texture::noisy ? std::abs(v) : 1 + 0.8f * v;
            if (ratio)
                v *= traits.lead_bounds[p / 3] * page[p % 3][i];
            else if (texture == Texture::noisy)
                v = std::ldexp(v, static_cast<int>(generator() % 10) - 4);
            page[p][i] = v;
        }
    }
    return page;
}

/// The largest error as a share of what the storage's bound allows, over a page.
double share_of_bound(const Storage& storage, const CoefficientTraits& traits, const LightmapPage& page) {
    const LightmapPage back = page.through(storage.layout(traits));
    LightmapPage allowed = page;
    allowed_error(storage, traits, page.view(), allowed.view());
    double worst = 0;
    for (std::size_t p = 0; p < page.planes(); ++p)
        for (std::size_t i = 0; i < page.size(); ++i) {
            const double error = std::abs(static_cast<double>(back[p][i]) - page[p][i]);
            EXPECT_TRUE(std::isfinite(allowed[p][i])) << "stored values are outside of the storage's limits";
            // Floats round once more.
            const double limit = allowed[p][i] + 1e-6 * std::abs(page[p][i]);
            worst = std::max(worst, error == 0 ? 0 : error / limit);
        }
    return worst;
}

TEST(Storages, BoundsHoldAndAreTight) {
    std::map<std::string_view, double> worst;
    for (const auto& [name, traits] : all_traits())
        for (const Storage& storage : storages()) {
            if (!suits(storage, traits)) continue;
            SCOPED_TRACE(std::string(storage.name) + " of " + name);
            for (std::uint32_t seed = 1; seed <= 4; ++seed) {
                const Texture texture = seed % 2 ? Texture::noisy : Texture::smooth;
                const double share = share_of_bound(storage, traits, random_page(traits, 21, 14, seed, texture));
                EXPECT_LE(share, 1);
                worst[storage.name] = std::max(worst[storage.name], share);
            }
        }
    // Check that the bound is not stated much too large.
    for (const Storage& storage : storages()) {
        if (storage.bound.relative == 0) {
            EXPECT_EQ(worst[storage.name], 0) << storage.name;
            continue;
        }
        EXPECT_GE(worst[storage.name], 0.6) << storage.name;
    }
}

TEST(Storages, SingleTexelsHoldTheirBoundsToo) {
    // A single texel, as for a probe or a comparison: sharing between texels costs nothing.
    for (const auto& [name, traits] : all_traits())
        for (const Storage& storage : storages()) {
            if (!suits(storage, traits)) continue;
            SCOPED_TRACE(std::string(storage.name) + " of " + name);
            for (std::uint32_t seed = 1; seed <= 20; ++seed)
                EXPECT_LE(share_of_bound(storage, traits, random_page(traits, 1, 1, seed, Texture::noisy)), 1);
        }
}

TEST(Storages, HugeAndTinyCoefficientsHoldTheirBounds) {
    for (const auto& [name, traits] : all_traits())
        for (const Storage& storage : storages()) {
            if (!suits(storage, traits)) continue;
            SCOPED_TRACE(std::string(storage.name) + " of " + name);
            for (const float scale : {1e-6f, 1e-3f, 1e4f, 1e7f, 1e12f}) {
                LightmapPage page = random_page(traits, 9, 7, 5, Texture::noisy);
                for (std::size_t p = 0; p < page.planes(); ++p)
                    for (float& v : page[p]) v *= scale;
                EXPECT_LE(share_of_bound(storage, traits, page), 1) << scale;
            }
        }
}

TEST(Storages, BlackStaysBlack) {
    for (const auto& [name, traits] : all_traits())
        for (const Storage& storage : storages()) {
            if (!suits(storage, traits)) continue;
            const LightmapPage black(6, 5, traits.count), back = black.through(storage.layout(traits));
            for (std::size_t p = 0; p < back.planes(); ++p)
                for (const float v : back[p]) EXPECT_EQ(v, 0) << storage.name;
        }
}

TEST(Storages, OneAfterTheOtherIsTheSame) {
    // Wide enough for many strips, with a height that no block divides.
    for (const auto& [name, traits] : all_traits())
        for (const Storage& storage : storages()) {
            if (!suits(storage, traits) || traits.count > 4) continue;
            SCOPED_TRACE(std::string(storage.name) + " of " + name);
            const LightmapPage page = random_page(traits, 700, 21, 3, Texture::noisy);
            const TextureLayout layout = storage.layout(traits);
            const auto together = pack(layout, page.view());
            std::size_t i = 0;
            const auto same = [&](const TextureLayout::Texture& texture, const PackedTexture& packed) -> Status {
                EXPECT_EQ(texture.name, packed.name);
                EXPECT_EQ(packed.name, together[i].name);
                EXPECT_EQ(packed.scale, together[i].scale);
                EXPECT_EQ(packed.data, together[i].data);
                ++i;
                return Done{};
            };
            EXPECT_TRUE(pack_each(layout, page.view(), same));
            EXPECT_EQ(i, together.size());
            // The first error ends the packing.
            i = 0;
            const auto ended = [&](const auto&, const auto&) -> Status { return ++i, Error{"full"}; };
            EXPECT_FALSE(pack_each(layout, page.view(), ended));
            EXPECT_EQ(i, 1u);
        }
}

TEST(Storages, RowsArePackedAsIfAlone) {
    // Eight rows, which no block and no sub-sampled texel crosses, give the same bytes alone as in a page of many
    // strips, unless the page's largest value determines the scale.
    for (const auto& [name, traits] : all_traits())
        for (const Storage& storage : storages()) {
            if (!suits(storage, traits) || traits.count > 4) continue;
            SCOPED_TRACE(std::string(storage.name) + " of " + name);
            const LightmapPage page = random_page(traits, 700, 21, 3, Texture::noisy);
            const TextureLayout layout = storage.layout(traits);
            const auto whole = pack(layout, page.view());
            std::vector<std::size_t> at(whole.size());
            for (std::size_t y = 0; y < 21; y += 8) {
                CoefficientPlanes band = page.view();
                band.height = std::min<std::size_t>(8, 21 - y);
                for (const float*& plane : band.planes) plane += y * band.width;
                const auto part = pack(layout, band);
                for (std::size_t i = 0; i < part.size(); ++i) {
                    if (whole[i].scale == part[i].scale) {
                        EXPECT_TRUE(std::equal(part[i].data.begin(), part[i].data.end(),
                                               whole[i].data.begin() + static_cast<std::ptrdiff_t>(at[i])))
                            << part[i].name << ", row " << y;
                    } else {
                        EXPECT_EQ(storage.name, "rgbm");
                    }
                    at[i] += part[i].data.size();
                }
            }
        }
}

TEST(Storages, EachChannelIsStoredOnce) {
    for (const auto& [name, traits] : all_traits())
        for (const Storage& storage : storages()) {
            if (!suits(storage, traits)) continue;
            SCOPED_TRACE(std::string(storage.name) + " of " + name);
            const TextureLayout layout = storage.layout(traits);
            EXPECT_EQ(layout.coefficients, traits.count);
            std::map<std::size_t, std::set<Component>> seen;
            std::set<std::string> names;
            for (const auto& texture : layout.textures) {
                EXPECT_TRUE(names.insert(texture.name).second) << texture.name;
                EXPECT_LE(texture.channels.size(), info(texture.format).channels);
                EXPECT_FALSE(texture.channels.empty());
                for (const StoredChannel& channel : texture.channels)
                    EXPECT_TRUE(seen[channel.coefficient].insert(channel.component).second);
            }
            const std::set<Component> rgb = {Component::r, Component::g, Component::b};
            const std::set<Component> ycocg = {Component::luma, Component::chroma_orange, Component::chroma_green};
            ASSERT_EQ(seen.size(), traits.count);
            for (const auto& [coefficient, components] : seen) EXPECT_TRUE(components == rgb || components == ycocg);
        }
}

TEST(Storages, TexturesAreOfTheStatedSize) {
    for (const auto& [name, traits] : all_traits())
        for (const Storage& storage : storages()) {
            if (!suits(storage, traits)) continue;
            const TextureLayout layout = storage.layout(traits);
            std::size_t bytes = 0;
            for (const PackedTexture& texture : pack(layout, LightmapPage(64, 64, traits.count).view()))
                bytes += texture.data.size();
            EXPECT_DOUBLE_EQ(static_cast<double>(bytes) / (64 * 64), bytes_per_texel(layout)) << storage.name;
        }
}

TEST(Storages, KnownSizes) {
    const auto bytes = [](const char* name, CoefficientTraits traits) {
        return bytes_per_texel(find_storage(name).value()->layout(traits));
    };
    CoefficientTraits four{4, false, true, {1, 1, 1, 1}};
    EXPECT_EQ(bytes("float32", four), 48);
    EXPECT_EQ(bytes("float16", four), 24);
    EXPECT_EQ(bytes("ycocg", four), 12);
    EXPECT_EQ(bytes("bc6h-signed", four), 4);
    EXPECT_EQ(bytes("ratio8", four), 13);
    EXPECT_EQ(bytes("ratio10", four), 16);
    EXPECT_EQ(bytes("bc6h-ratio8", four), 10);
    EXPECT_EQ(bytes("rgb9e5", {12, true, true, {}}), 48);
}

TEST(Storages, WhatSuitsFollowsFromTheTraits) {
    const auto names = [](const CoefficientTraits& traits) {
        std::set<std::string_view> result;
        for (const Storage& storage : storages())
            if (suits(storage, traits)) result.insert(storage.name);
        return result;
    };
    for (const Storage& storage : storages())
        EXPECT_EQ(names({3, false, false, {}}).contains(storage.name), storage.suits == Storage::Suits::any)
            << storage.name;
    for (const char* any : {"float32", "float16", "bc6h-signed"})
        EXPECT_TRUE(names({3, false, false, {}}).contains(any)) << any;
    EXPECT_TRUE(names({3, false, true, {}}).contains("ycocg"));
    EXPECT_TRUE(names({3, true, false, {}}).contains("rgb9e5"));
    EXPECT_FALSE(names({3, false, true, {}}).contains("bc6h"));
    EXPECT_TRUE(names({3, false, true, {1, 2, 2}}).contains("ratio8"));
    EXPECT_FALSE(names({3, true, true, {}}).contains("ratio8"));
}

TEST(Storages, OnlyColoursHaveChroma) {
    for (const auto& name : basis_names()) {
        SCOPED_TRACE(name);
        const auto basis = make_basis(name).value();
        const auto meanings = basis->meanings();
        const bool has_shapes = std::find(meanings.begin(), meanings.end(), Meaning::shape) != meanings.end();
        const auto encoder = make_encoder(encoder_names(*basis).front(), basis).value();
        EXPECT_EQ(suits(*find_storage("ycocg").value(), coefficient_traits(*encoder)), !has_shapes);
    }
}

TEST(Storages, LayoutsAsText) {
    const TextureLayout layout = find_storage("ratio8").value()->layout({2, false, true, {1, 2}});
    EXPECT_EQ(
        layout_json(layout),
        R"({"coefficients": 2, "textures": [{"name": "c0", "format": "rgb9e5", "vk_format": 123, "subsampling": 1, )"
        R"("channels": [{"coefficient": 0, "component": "r", "form": "value", "scale": 1, "offset": 0}, )"
        R"({"coefficient": 0, "component": "g", "form": "value", "scale": 1, "offset": 0}, )"
        R"({"coefficient": 0, "component": "b", "form": "value", "scale": 1, "offset": 0}]}, )"
        R"({"name": "ratio0", "format": "rgba8", "vk_format": 37, "subsampling": 1, )"
        R"("channels": [{"coefficient": 1, "component": "r", "form": "ratio", "scale": 0.25, "offset": 0.5}, )"
        R"({"coefficient": 1, "component": "g", "form": "ratio", "scale": 0.25, "offset": 0.5}, )"
        R"({"coefficient": 1, "component": "b", "form": "ratio", "scale": 0.25, "offset": 0.5}]}]})");
    EXPECT_EQ(channel_text(layout.textures[1].channels[0]), "0.5 + 0.25 c1.r / c0.r");
    EXPECT_EQ(channel_text(layout.textures[0].channels[2]), "c0.b");
}

TEST(Storages, UnknownNamesAreErrors) {
    EXPECT_TRUE(find_storage("float16"));
    const auto unknown = find_storage("flaot16");
    ASSERT_FALSE(unknown);
    EXPECT_NE(unknown.error().message.find("float16"), std::string::npos);
}

TEST(Storages, OnesThatDoNotSuitAreErrorsThatSayWhatDoes) {
    const CoefficientTraits traits{3, false, false, {}};
    const auto found = find_storages(std::array<std::string, 3>{"float16", "bc6h-signed", "float16"}, traits);
    ASSERT_TRUE(found);
    ASSERT_EQ(found->size(), 2u);
    EXPECT_EQ((*found)[1]->name, "bc6h-signed");
    const auto ratios = find_storages(std::array<std::string, 1>{"ratio8"}, traits);
    ASSERT_FALSE(ratios);
    EXPECT_NE(ratios.error().message.find("usable with this codec: float32, float16, bc6h-signed"), std::string::npos);
    EXPECT_FALSE(find_storages(std::array<std::string, 1>{"float17"}, traits));
    EXPECT_EQ(default_storages(traits).size(), 1u);
    EXPECT_EQ(default_storages({3, false, true, {1, 2, 2}}).size(), 2u);
}

TEST(LeadBounds, HoldForAnyLightThatIsNotNegative) {
    // Coefficients of single lights from all directions, which are the extreme points of all lights, and of pairs of
    // lights, because not all coefficients are linear.
    for (const auto& name : basis_names()) {
        const auto basis = make_basis(name).value();
        const auto bounds = basis->lead_bounds();
        if (bounds.empty()) continue;
        SCOPED_TRACE(name);
        ASSERT_EQ(bounds.size(), basis->size());
        EXPECT_EQ(bounds[0], 1);
        const auto encoder = make_encoder("moments", basis).value();
        std::vector<float> largest(bounds.size());
        const Directions directions = test::random_directions(basis->domain(), 400, 9);
        for (std::size_t i = 0; i < directions.size(); ++i) {
            Samples light(2);
            light.set(0, {direction_at(directions, i), {1, 1, 1}, 1});
            const auto other = static_cast<float>(i % 4) / 3;
            light.set(1, {direction_at(directions, (7 * i + 1) % directions.size()), {other, other, other}, 1});
            Accumulator accumulator(encoder);
            accumulator.add(light);
            const auto c = accumulator.solve();
            for (std::size_t k = 0; k < c.size(); ++k) {
                EXPECT_LE(std::abs(c[k].g), bounds[k] * c[0].g * 1.00001f) << k;
                largest[k] = std::max(largest[k], std::abs(c[k].g) / c[0].g);
            }
        }
        // A bound that is too wide wastes resolution.
        for (std::size_t k = 0; k < bounds.size(); ++k) EXPECT_GE(largest[k], 0.5f * bounds[k]) << k;
    }
}

TEST(Storages, ProbesComeBackAsPagesDo) {
    const auto encoder = make_encoder("least-squares", make_basis(basis_names().front()).value()).value();
    const auto traits = coefficient_traits(*encoder);
    const LightmapPage page = random_page(traits, 1, 1, 3, Texture::noisy);
    std::vector<Rgb> c;
    for (std::size_t i = 0; i < traits.count; ++i)
        c.push_back({page[3 * i][0], page[3 * i + 1][0], page[3 * i + 2][0]});
    for (const Storage& storage : storages()) {
        if (!suits(storage, traits)) continue;
        const LightmapPage back = page.through(storage.layout(traits));
        const auto read = stored_and_read(storage, traits, c);
        for (std::size_t i = 0; i < traits.count; ++i)
            EXPECT_EQ(read[i], (Rgb{back[3 * i][0], back[3 * i + 1][0], back[3 * i + 2][0]}));
    }
}

}  // namespace
}  // namespace lobelia
