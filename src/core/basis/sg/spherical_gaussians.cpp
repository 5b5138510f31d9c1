// The basis of spherical Gaussians: lobe sets, vectorised values, Gram matrices in closed form or by quadrature.
#include "core/basis/sg/spherical_gaussians.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <optional>
#include <sstream>

#include "core/basis/sg/sg_irradiance.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/basis/sg/spherical_gaussians.cpp"
#include <hwy/foreach_target.h>  // NOLINT: must precede highway.h
#include <hwy/highway.h>
// NOLINTNEXTLINE: after highway.h
#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace lobelia::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// row = exp(-lambda |s - p|^2 / 2), which keeps its precision at every sharpness, as lambda (s . p - 1) does not.
/// Below e^-43 it is 0: its square is then a normal float or 0, since with others a machine is slow.
void GaussianRow(const gaussian::Lobe& lobe, DirectionView block, float* row) {
    const hn::CappedTag<float, k_lanes> d;
    const auto px = hn::Set(d, lobe.axis.x), py = hn::Set(d, lobe.axis.y), pz = hn::Set(d, lobe.axis.z);
    const auto scale = hn::Set(d, -0.5f * lobe.sharpness);
    for (std::size_t j = 0; j < block.size; j += hn::Lanes(d)) {
        const auto x = hn::Sub(hn::LoadU(d, block.channel(0) + j), px);
        const auto y = hn::Sub(hn::LoadU(d, block.channel(1) + j), py);
        const auto z = hn::Sub(hn::LoadU(d, block.channel(2) + j), pz);
        const auto squared = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
        const auto exponent = hn::Mul(scale, squared);
        hn::StoreU(hn::IfThenElseZero(hn::Gt(exponent, hn::Set(d, -43.0f)), hn::Exp(d, exponent)), d, row + j);
    }
}

}  // namespace lobelia::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia {

HWY_EXPORT(GaussianRow);

using gaussian::Lobe;

namespace {

const double k_golden_angle = k_pi * (3 - std::sqrt(5.0));

/// Point of azimuth index * golden angle at height z.
Vec3 spiral_point(std::size_t index, double z) {
    const double r = std::sqrt(1 - z * z), phi = k_golden_angle * static_cast<double>(index);
    return {static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)), static_cast<float>(z)};
}

constexpr std::size_t k_most_lobes = 512;

std::optional<float> parse_sharpness(std::string_view text) {
    float sharpness = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), sharpness);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return sharpness >= 0.01f && sharpness <= 1e4f ? std::optional(sharpness) : std::nullopt;
}

Result<std::vector<Lobe>> parse_lobes(std::istream& in, const std::string& path) {
    std::vector<Lobe> lobes;
    std::string line;
    for (std::size_t number = 1; std::getline(in, line); ++number) {
        line = line.substr(0, line.find('#'));
        std::istringstream fields(line);
        std::string word;
        if (!(fields >> word)) continue;
        const std::string place = path + ":" + std::to_string(number) + ": ";
        if (word == "ambient") {
            if (fields >> word) return Error{place + "nothing may follow \"ambient\""};
            lobes.push_back({{0, 0, 1}, 0});
        } else {
            std::istringstream values(line);
            Vec3 axis;
            float sharpness = 0;
            std::string rest;
            if (!(values >> axis.x >> axis.y >> axis.z >> sharpness) || (values >> rest))
                return Error{place + "expected \"x y z sharpness\" or \"ambient\""};
            if (!(length(axis) > 1e-6f) || !(length(axis) < 1e6f)) return Error{place + "the axis has no direction"};
            if (!(sharpness >= 0 && sharpness <= 1e4f)) return Error{place + "sharpness must be 0 to 10000"};
            lobes.push_back({normalize(axis), sharpness});
        }
        if (lobes.size() > k_most_lobes) return Error{place + "more than " + std::to_string(k_most_lobes) + " lobes"};
    }
    if (lobes.empty()) return Error{path + ": no lobes in it"};
    return lobes;
}

}  // namespace

std::vector<Lobe> vogel_sphere(std::size_t count) {
    std::vector<Lobe> lobes(count);
    const auto n = static_cast<double>(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double t = count > 1 ? static_cast<double>(i) / (n - 1) : 0;
        const double z = (1 - 1 / n) * (1 - t) + (1 / n - 1) * t;
        lobes[i] = {spiral_point(i, z), static_cast<float>(n / 2)};
    }
    return lobes;
}

std::vector<Lobe> spiral_hemisphere(std::size_t count) {
    std::vector<Lobe> lobes;
    const auto n = static_cast<double>(count);
    for (std::size_t k = 0; k < 2 * count; ++k) {
        const double z = (static_cast<double>(k) + 0.5) / n - 1;
        if (z >= 0) lobes.push_back({spiral_point(k, z), 0});
    }
    double least = 1;
    for (const Lobe& lobe : lobes)
        if (lobe != lobes[0])
            least = std::min(least, static_cast<double>(dot(normalize(lobe.axis + lobes[0].axis), lobes[0].axis)));
    const double sharpness = std::log(0.65) * n / (least - 1.0001);
    // A single lobe has no neighbour to meet; give it the width of the hemisphere.
    for (Lobe& lobe : lobes) lobe.sharpness = static_cast<float>(count > 1 ? sharpness : 1);
    return lobes;
}

Result<std::vector<Lobe>> read_lobes(const std::string& path) {
    std::ifstream file(path);
    if (!file) return Error{path + ": cannot be opened as a set of lobes"};
    return parse_lobes(file, path);
}

void gaussian_row(const Lobe& lobe, DirectionView block, float* row) {
    HWY_DYNAMIC_DISPATCH(GaussianRow)(lobe, block, row);
}

SphericalGaussians::SphericalGaussians(std::string name, std::vector<Lobe> lobes, Domain domain)
    : name_(std::move(name)), lobes_(std::move(lobes)), domain_(domain) {}

Result<std::shared_ptr<const Basis>> SphericalGaussians::from_name(std::string_view name) {
    const auto make = [&](std::vector<Lobe> lobes, Domain domain) -> std::shared_ptr<const Basis> {
        return std::make_shared<SphericalGaussians>(std::string(name), std::move(lobes), domain);
    };
    const std::shared_ptr<const Basis> none;

    // A set from a file.
    for (const auto& [prefix, domain] : {std::pair{"sg:", Domain::sphere}, std::pair{"sgh:", Domain::hemisphere}})
        if (name.starts_with(prefix)) {
            auto lobes = read_lobes(std::string(name.substr(std::string_view(prefix).size())));
            if (!lobes) return lobes.error();
            return make(*std::move(lobes), domain);
        }

    // A generated set: sg, a number, and what kind of set.
    if (!name.starts_with("sg")) return none;
    std::size_t count = 0;
    const auto [end, error] = std::from_chars(name.data() + 2, name.data() + name.size(), count);
    if (error == std::errc::invalid_argument) return none;
    if (error != std::errc() || count < 1 || count > k_most_lobes)
        return Error{"basis \"" + std::string(name) + "\": the number of lobes must be 1 to " +
                     std::to_string(k_most_lobes)};
    std::string_view kind = name.substr(static_cast<std::size_t>(end - name.data()));
    std::optional<float> sharpness;
    if (const auto at = kind.find('@'); at != std::string_view::npos) {
        const auto parsed = parse_sharpness(kind.substr(at + 1));
        if (!parsed) return Error{"basis \"" + std::string(name) + "\": the sharpness after @ must be 0.01 to 10000"};
        sharpness = *parsed;
        kind = kind.substr(0, at);
    }
    if (!kind.empty() && kind != "a" && kind != "h") return none;
    auto lobes = kind == "h" ? spiral_hemisphere(count) : vogel_sphere(count);
    if (sharpness)
        for (Lobe& lobe : lobes) lobe.sharpness = *sharpness;
    if (kind == "a") lobes.push_back({{0, 0, 1}, 0});
    return make(std::move(lobes), kind == "h" ? Domain::hemisphere : Domain::sphere);
}

void SphericalGaussians::values(DirectionView block, float* rows) const {
    for (std::size_t i = 0; i < lobes_.size(); ++i) gaussian_row(lobes_[i], block, rows + i * k_block_size);
}

std::string SphericalGaussians::description() const {
    std::ostringstream text;
    text << lobes_.size() << " spherical Gaussians over the "
         << (domain_ == Domain::sphere ? "sphere" : "hemisphere z >= 0") << ", sharpness ";
    const auto [low, high] = std::minmax_element(
        lobes_.begin(), lobes_.end(), [](const Lobe& a, const Lobe& b) { return a.sharpness < b.sharpness; });
    text << low->sharpness;
    if (high->sharpness != low->sharpness) text << " to " << high->sharpness;
    if (low->sharpness == 0) text << " (0 is ambient)";
    return text.str();
}

BasisNotes SphericalGaussians::notes() const {
    return {"Spherical Gaussians",
            "L(w) = sum of c_i exp(lambda_i (w . p_i - 1)), on fixed axes p_i with fixed sharpness lambda_i",
            "radiance that stays positive (with a non-negative encoder); glossy reflection, since a lobe times a lobe "
            "is a lobe; as many lobes as the budget allows",
            "irradiance by plain least squares (the joint norm mends it); turning, as the axes are fixed"};
}

Matrix SphericalGaussians::gram() const {
    std::call_once(gram_once_, [&] {
        const std::size_t n = lobes_.size();
        gram_.resize(n * n);
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = i; j < n; ++j)
                gram_[i * n + j] = gram_[j * n + i] = domain_ == Domain::sphere
                                                          ? gaussian::inner_product(lobes_[i], lobes_[j])
                                                          : gaussian::hemisphere_inner_product(lobes_[i], lobes_[j]);
    });
    return gram_;
}

std::vector<double> SphericalGaussians::integrals() const {
    std::vector<double> result;
    for (const Lobe& lobe : lobes_)
        result.push_back(domain_ == Domain::sphere ? gaussian::integral(lobe.sharpness)
                                                   : gaussian::hemisphere_integral(lobe.sharpness, lobe.axis.z));
    return result;
}

std::vector<std::string> SphericalGaussians::evaluator_names() const {
    std::vector<std::string> names;
    for (const auto& entry : sg_irradiance_list()) names.emplace_back(entry.name);
    return names;
}

std::shared_ptr<const Evaluator> SphericalGaussians::evaluator(std::string_view name) const {
    const auto kind = sg_irradiance_from_name(name);
    return kind ? std::make_shared<SgIrradianceWeights>(*kind, lobes_) : nullptr;
}

Basis::Rotated SphericalGaussians::rotated(const Rotation& r, std::span<const Rgb> c) const {
    std::vector<Lobe> lobes = lobes_;
    for (Lobe& lobe : lobes) lobe.axis = rotate(r, lobe.axis);
    return {std::make_shared<SphericalGaussians>(name_, std::move(lobes), domain_), {c.begin(), c.end()}};
}

}  // namespace lobelia
#endif
