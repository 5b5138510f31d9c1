// The basis of spherical Gaussians: lobe sets, vectorised values, Gram matrices in closed form or by quadrature.
#include "core/basis/sg/spherical_gaussians.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <sstream>

#include "core/basis/sg/sg_irradiance.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/basis/sg/spherical_gaussians.cpp"
#include <hwy/foreach_target.h>  // NOLINT: must precede highway.h
#include <hwy/highway.h>
// NOLINTNEXTLINE: after highway.h
#include <hwy/contrib/math/math-inl.h>

// NOLINTNEXTLINE: after highway.h
#include "core/math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lobelia::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// exp(-lambda |s - p|^2 / 2), which keeps its precision at every sharpness, as lambda (s . p - 1) does not. Below
/// e^-43 it is 0: its square is then a normal float or 0, since with others a machine is slow.
HWY_INLINE V gaussian_value(D d, const Lanes3& s, const Lanes3& p, V sharpness) {
    const V x = hn::Sub(s.x, p.x), y = hn::Sub(s.y, p.y), z = hn::Sub(s.z, p.z);
    const V squared = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
    const V exponent = hn::Mul(hn::Mul(hn::Set(d, -0.5f), sharpness), squared);
    return hn::IfThenElseZero(hn::Gt(exponent, hn::Set(d, -43.0f)), hn::Exp(d, exponent));
}

/// Lanes run over directions.
void GaussianRow(const Lobe& lobe, DirectionView block, float* row) {
    const D d;
    const Lanes3 p = {hn::Set(d, lobe.axis.x), hn::Set(d, lobe.axis.y), hn::Set(d, lobe.axis.z)};
    const V sharpness = hn::Set(d, lobe.sharpness);
    for (std::size_t j = 0; j < block.size; j += hn::Lanes(d))
        hn::StoreU(gaussian_value(d, load(d, block, j), p, sharpness), d, row + j);
}

/// Lanes run over `count` lobes: rows x, y, z, sharpness of `lobes`, whole lanes of them.
void GaussiansAt(const float* const* lobes, std::size_t count, Vec3 direction, float* values) {
    const D d;
    const Lanes3 s = {hn::Set(d, direction.x), hn::Set(d, direction.y), hn::Set(d, direction.z)};
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        const Lanes3 p = {hn::LoadU(d, lobes[0] + i), hn::LoadU(d, lobes[1] + i), hn::LoadU(d, lobes[2] + i)};
        hn::StoreU(gaussian_value(d, s, p, hn::LoadU(d, lobes[3] + i)), d, values + i);
    }
}

}  // namespace lobelia::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia {

HWY_EXPORT(GaussianRow);
HWY_EXPORT(GaussiansAt);

namespace {

const double k_golden_angle = k_pi * (3 - std::sqrt(5.0));

/// Point of azimuth index * golden angle at height z.
Vec3 spiral_point(std::size_t index, double z) {
    const double r = std::sqrt(1 - z * z), phi = k_golden_angle * static_cast<double>(index);
    return {static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)), static_cast<float>(z)};
}

constexpr std::size_t k_most_lobes = 512;
constexpr float k_least_sharpness = 0.01f, k_most_sharpness = 1e4f;

void check_sharpness(float sharpness, float least, SourcePlace place = SourcePlace::here()) {
    if (!(sharpness >= least && sharpness <= k_most_sharpness))
        contract_violated("sharpness: " + std::to_string(sharpness) + ", must be " + std::to_string(least) + " to " +
                              std::to_string(k_most_sharpness),
                          place);
}

std::optional<float> parse_sharpness(std::string_view text) {
    float sharpness = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), sharpness);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return sharpness >= k_least_sharpness && sharpness <= k_most_sharpness ? std::optional(sharpness) : std::nullopt;
}

Result<Lobe> parse_lobe(const std::string& line) {
    std::istringstream fields(line);
    std::string word, rest;
    fields >> word;
    if (word == "ambient") {
        if (fields >> rest) return Error{"nothing may follow \"ambient\""};
        return Lobe{};
    }
    std::istringstream values(line);
    Lobe lobe;
    Vec3& axis = lobe.axis;
    if (!(values >> axis.x >> axis.y >> axis.z >> lobe.sharpness) || (values >> rest))
        return Error{"expected \"x y z sharpness\" or \"ambient\""};
    if (!(length(axis) > 1e-6f) || !(length(axis) < 1e6f)) return Error{"the axis has no direction"};
    if (!(lobe.sharpness >= 0 && lobe.sharpness <= k_most_sharpness)) return Error{"sharpness must be 0 to 10000"};
    // An axis that is unit already stays as it is, so that names give back the very lobes that they were made from.
    if (std::abs(length(axis) - 1) > 1e-6f) axis = normalize(axis);
    return lobe;
}

/// The shortest text that gives the number back.
void append_number(std::string& text, float number) {
    char digits[32];
    text.append(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
}

/// The names "sg{...}" and "sgh{...}" hold lobes: these begin and end them, ';' is between lobes.
std::string_view opening(Domain domain) { return domain == Domain::sphere ? "sg{" : "sgh{"; }

std::string name_of(std::span<const Lobe> lobes, Domain domain) {
    std::string name(opening(domain));
    for (const Lobe& lobe : lobes) {
        if (&lobe != &lobes.front()) name += ";";
        if (lobe.sharpness == 0) {
            name += "ambient";
            continue;
        }
        for (const float number : {lobe.axis.x, lobe.axis.y, lobe.axis.z, lobe.sharpness}) {
            if (name.back() != '{' && name.back() != ';') name += " ";
            append_number(name, number);
        }
    }
    return name + "}";
}

/// The inverse of name_of; nothing where the name is of another form.
std::optional<Result<std::shared_ptr<const Basis>>> from_lobes_in_name(std::string_view name) {
    for (const Domain domain : {Domain::sphere, Domain::hemisphere}) {
        if (!name.starts_with(opening(domain)) || !name.ends_with("}")) continue;
        std::string text(name.substr(opening(domain).size()));
        text.pop_back();
        std::replace(text.begin(), text.end(), ';', '\n');
        auto lobes = parse_lobes(text, "lobes of the basis's name");
        if (!lobes) return lobes.error();
        return std::shared_ptr<const Basis>(spherical_gaussians(*std::move(lobes), domain));
    }
    return std::nullopt;
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

Result<std::vector<Lobe>> parse_lobes(std::string_view text, std::string_view source) {
    std::vector<Lobe> lobes;
    std::istringstream in{std::string(text)};
    std::string line;
    for (std::size_t number = 1; std::getline(in, line); ++number) {
        line = line.substr(0, line.find('#'));
        if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
        const auto lobe = parse_lobe(line);
        const std::string place = std::string(source) + ":" + std::to_string(number) + ": ";
        if (!lobe) return Error{place + lobe.error().message};
        lobes.push_back(*lobe);
        if (lobes.size() > k_most_lobes) return Error{place + "more than " + std::to_string(k_most_lobes) + " lobes"};
    }
    if (lobes.empty()) return Error{std::string(source) + ": it holds no lobes"};
    return lobes;
}

void gaussian_row(const Lobe& lobe, DirectionView block, float* row) {
    HWY_DYNAMIC_DISPATCH(GaussianRow)(lobe, block, row);
}

SphericalGaussians::SphericalGaussians(std::string name, std::vector<Lobe> lobes, Domain domain)
    : name_(std::move(name)), lobes_(std::move(lobes)), domain_(domain), rows_(lobes_.size()) {
    for (std::size_t i = 0; i < lobes_.size(); ++i) {
        set_entry(rows_.view().channels<3>(0), i, lobes_[i].axis);
        rows_.channel(3)[i] = lobes_[i].sharpness;
    }
}

std::shared_ptr<const LinearBasis> spherical_gaussians(std::size_t count, const GaussianOptions& options) {
    check_range("lobes", count, 1, k_most_lobes);
    const bool whole = options.domain == Domain::sphere, ambient = options.ambient == GaussianOptions::Ambient::one;
    if (!whole && ambient) contract_violated("an ambient lobe on the hemisphere: it is for the sphere only");
    auto lobes = whole ? vogel_sphere(count) : spiral_hemisphere(count);
    std::string name = "sg" + std::to_string(count) + (whole ? ambient ? "a" : "" : "h");
    if (options.sharpness) {
        check_sharpness(*options.sharpness, k_least_sharpness);
        for (Lobe& lobe : lobes) lobe.sharpness = *options.sharpness;
        name += "@";
        append_number(name, *options.sharpness);
    }
    if (ambient) lobes.push_back({});
    return std::make_shared<SphericalGaussians>(std::move(name), std::move(lobes), options.domain);
}

std::vector<Lobe> lobes_of(const Basis& basis) {
    const auto* gaussians = dynamic_cast<const SphericalGaussians*>(&basis);
    return gaussians == nullptr ? std::vector<Lobe>() : gaussians->lobes();
}

std::shared_ptr<const LinearBasis> spherical_gaussians(std::vector<Lobe> lobes, Domain domain) {
    check_range("lobes", lobes.size(), 1, k_most_lobes);
    for (const Lobe& lobe : lobes) check_sharpness(lobe.sharpness, 0);
    std::string name = name_of(lobes, domain);
    return std::make_shared<SphericalGaussians>(std::move(name), std::move(lobes), domain);
}

Result<std::shared_ptr<const Basis>> SphericalGaussians::from_name(std::string_view name) {
    const std::shared_ptr<const Basis> none;
    if (!name.starts_with("sg")) return none;
    if (auto basis = from_lobes_in_name(name)) return *std::move(basis);
    if (name.starts_with("sg:") || name.starts_with("sgh:"))
        return Error{"files of lobes (sg:FILE) are opened for the command line alone; the name sg{...} holds lobes"};

    // A generated set: sg, a number, and what kind of set.
    std::size_t count = 0;
    const auto [end, error] = std::from_chars(name.data() + 2, name.data() + name.size(), count);
    if (error == std::errc::invalid_argument) return none;
    if (error != std::errc() || count < 1 || count > k_most_lobes)
        return Error{"basis \"" + std::string(name) + "\": the number of lobes must be 1 to " +
                     std::to_string(k_most_lobes)};
    std::string_view kind = name.substr(static_cast<std::size_t>(end - name.data()));
    GaussianOptions options;
    if (const auto at = kind.find('@'); at != std::string_view::npos) {
        options.sharpness = parse_sharpness(kind.substr(at + 1));
        if (!options.sharpness)
            return Error{"basis \"" + std::string(name) + "\": the sharpness after @ must be 0.01 to 10000"};
        kind = kind.substr(0, at);
    }
    if (!kind.empty() && kind != "a" && kind != "h") return none;
    if (kind == "a") options.ambient = GaussianOptions::Ambient::one;
    if (kind == "h") options.domain = Domain::hemisphere;
    return std::shared_ptr<const Basis>(spherical_gaussians(count, options));
}

void SphericalGaussians::values(DirectionView block, float* rows) const {
    for (std::size_t i = 0; i < lobes_.size(); ++i) gaussian_row(lobes_[i], block, rows + i * k_block_size);
}

void SphericalGaussians::values_at(Vec3 direction, float* values) const {
    HWY_DYNAMIC_DISPATCH(GaussiansAt)(rows_.view().pointers.data(), lobes_.size(), direction, values);
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
    check_equal("coefficients", c.size(), size());
    std::vector<Lobe> lobes = lobes_;
    for (Lobe& lobe : lobes) lobe.axis = rotate(r, lobe.axis);
    return {std::make_shared<SphericalGaussians>(name_, std::move(lobes), domain_), {c.begin(), c.end()}};
}

}  // namespace lobelia
#endif
