// Ambient dice: weights of the patches, tables by quadrature over the faces, irradiance by way of harmonics.
#include "core/basis/ambient_dice.h"

#include <algorithm>
#include <array>

#include "core/basis/ambient_dice_shader.h"
#include "core/basis/icosahedron.h"
#include "core/basis/turned_block.h"
#include "core/math/dense.h"
#include "core/math/harmonics.h"
#include "core/math/quadrature.h"

namespace lobelia {
namespace {

using icosahedron::faces;
using icosahedron::vertices;

constexpr std::size_t k_vertices = 12, k_functions = 3 * k_vertices;
/// Coefficients of AmbientDiceYCoCg: three numbers at each vertex, and two slopes, three to a coefficient.
constexpr std::size_t k_ycocg = k_vertices + 2 * k_vertices / 3;

/// Constants of a face: planes whose distances are the barycentric coordinates, and the direction of each edge from a
/// corner in the tangents of that corner.
struct Face {
    std::array<std::size_t, 3> corner{};
    Vec3 middle;
    std::array<Vec3, 3> plane;
    std::array<std::array<std::array<float, 2>, 2>, 3> edge{};  ///< [corner][next or last corner][tangent]
};

/// Two tangents at each vertex.
std::array<Vec3, 2> tangents_at(std::size_t vertex) {
    const Vec3 v = vertices()[vertex];
    const Vec3 u = normalize(cross(std::abs(v.z) < 0.5f ? Vec3{0, 0, 1} : Vec3{1, 0, 0}, v));
    return {u, cross(v, u)};
}

const std::array<Face, 20>& dice_faces() {
    static const std::array<Face, 20> list = [] {
        std::array<Face, 20> result;
        for (std::size_t f = 0; f < 20; ++f) {
            Face& face = result[f];
            face.corner = faces()[f];
            const auto v = [&](std::size_t k) { return vertices()[face.corner[k % 3]]; };
            face.middle = normalize(v(0) + v(1) + v(2));
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3 opposite = cross(v(k + 1), v(k + 2));
                face.plane[k] = opposite * (1 / dot(opposite, v(k)));
                const auto tangents = tangents_at(face.corner[k]);
                for (std::size_t e = 0; e < 2; ++e)
                    for (std::size_t t = 0; t < 2; ++t) face.edge[k][e][t] = dot(v(k + 1 + e), tangents[t]);
            }
        }
        return result;
    }();
    return list;
}

const Face& face_of(Vec3 w) {
    // A direction of NaN has the first face.
    const Face* best = dice_faces().data();
    float most = -2;
    for (const Face& face : dice_faces()) {
        const float along = dot(face.middle, w);
        if (along > most) {
            most = along;
            best = &face;
        }
    }
    return *best;
}

/// Barycentric coordinates w = b0 v0 + b1 v1 + b2 v2; rounding may take one below 0.
std::array<float, 3> barycentric(const Face& face, Vec3 w) {
    std::array<float, 3> b;
    for (std::size_t k = 0; k < 3; ++k) b[k] = std::max(0.0f, dot(face.plane[k], w));
    return b;
}

/// Weights of value and slopes at each corner. A cubic with control points f_a at the corners, c_ab = C f_a + (the
/// slope along the edge) / 3 beside them, C the cosine of an edge, and for the middle a blend, by M_k = 6 b0 b1 b2 b_a
/// b_b / (b0 b1 + b1 b2 + b2 b0), of the three points that let the slope across edge k run evenly from end to end.
std::array<std::array<float, 3>, 3> patch_weights(const Face& face, Vec3 w) {
    const auto b = barycentric(face, w);
    static const auto cosine = static_cast<float>(1 / std::sqrt(5.0));
    static const float across = cosine / (1 + cosine);  // the edge's normal is v_k - across (v_a + v_b), scaled
    const std::array<float, 3> pairs = {b[1] * b[2], b[2] * b[0], b[0] * b[1]};
    const float sum = std::max(pairs[0] + pairs[1] + pairs[2], 1e-20f);
    std::array<float, 3> middle;
    for (std::size_t k = 0; k < 3; ++k) middle[k] = 6 * b[0] * pairs[0] * pairs[k] / sum;

    std::array<std::array<float, 3>, 3> weights;
    float whole = 0;
    for (std::size_t a = 0; a < 3; ++a) {
        const std::size_t to[2] = {(a + 1) % 3, (a + 2) % 3};
        float edge[2];
        for (std::size_t e = 0; e < 2; ++e)
            edge[e] =
                3 * b[a] * b[a] * b[to[e]] + cosine / 2 * middle[to[e]] + across * (1 - cosine / 2) * middle[to[1 - e]];
        const float corner = b[a] * b[a] * b[a] - across * cosine / 2 * (middle[to[0]] + middle[to[1]]);
        weights[a][0] = corner + cosine * (edge[0] + edge[1]);
        for (std::size_t t = 0; t < 2; ++t)
            weights[a][1 + t] = (face.edge[a][0][t] * edge[0] + face.edge[a][1][t] * edge[1]) / 3;
        whole += weights[a][0];
    }
    for (auto& corner : weights)
        for (float& weight : corner) weight /= whole;
    return weights;
}

void clear(float* rows, std::size_t count, std::size_t size) {
    for (std::size_t i = 0; i < count; ++i) std::fill_n(rows + i * k_block_size, size, 0.0f);
}

/// Both kinds of functions side by side: 36 of the patches, then 12 that are linear between the vertices.
class DiceFunctions final : public FunctionSet {
  public:
    [[nodiscard]] std::size_t size() const override { return k_functions + k_vertices; }
    void values(DirectionView block, float* rows) const override {
        clear(rows, size(), block.size);
        for (std::size_t j = 0; j < block.size; ++j) {
            const Vec3 w = direction_at(block, j);
            const Face& face = face_of(w);
            const auto weights = patch_weights(face, w);
            const auto b = barycentric(face, w);
            const float sum = b[0] + b[1] + b[2];
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t vertex = face.corner[k];
                for (std::size_t t = 0; t < 3; ++t) rows[(3 * vertex + t) * k_block_size + j] = weights[k][t];
                rows[(k_functions + vertex) * k_block_size + j] = b[k] / sum;
            }
        }
    }
};

/// Points and weights over all faces: w = p / |p|, dw = |v0 . (v1 x v2)| s ds dt / |p|^3 on p = v0 + s (v1 - v0) + s t
/// (v2 - v1).
SphereRule face_rule() {
    constexpr std::size_t n = 20;
    const GaussLegendre rule(n, 0, 1);
    SphereRule result{Directions(20 * n * n), {}};
    for (const auto& corner : faces()) {
        const Vec3 a = vertices()[corner[0]], b = vertices()[corner[1]], c = vertices()[corner[2]];
        const double volume = dot(a, cross(b, c));
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j) {
                const double s = rule.nodes[i], t = rule.nodes[j];
                const Vec3 p = a + (b - a) * static_cast<float>(s) + (c - b) * static_cast<float>(s * t);
                const double size = length(p);
                set_entry(result.directions.view(), result.weights.size(), normalize(p));
                result.weights.push_back(rule.weights[i] * rule.weights[j] * s * volume / (size * size * size));
            }
    }
    return result;
}

using dice::Chroma;
using dice::k_degree;

/// Integrals that are computed once, in the frame of the dice.
struct Tables {
    Eigen::MatrixXd products;             ///< 48 x 48, of all functions
    std::vector<double> integrals;        ///< 48
    std::vector<float> irradiance;        ///< 48 x 81, row by row: harmonics of what each function gives
    Eigen::MatrixXd linear_from_patches;  ///< 12 x 36: the nearest linear function
    Tables() {
        const DiceFunctions functions;
        const SphereRule rule = face_rule();
        const std::size_t n = functions.size();
        products = as_matrix(inner_products(functions, functions, rule), n);
        integrals = lobelia::integrals(functions, rule);
        const lobelia::harmonics::Harmonics set(k_degree);
        for (const double coefficient : inner_products(functions, set, rule)) {
            const auto band = static_cast<std::size_t>(std::sqrt(static_cast<double>(irradiance.size() % set.size())));
            irradiance.push_back(static_cast<float>(harmonics::clamped_cosine(band) * coefficient));
        }
        linear_from_patches = products.bottomRightCorner<12, 12>().ldlt().solve(products.bottomLeftCorner<12, 36>());
    }
};
const Tables& tables() {
    static const Tables once;
    return once;
}

/// All 48 functions as coefficients: chroma and luminance back to colours.
struct Expanded {
    std::array<Rgb, k_functions> patches{};
    std::array<Rgb, k_vertices> linear{};
};
Expanded expanded(std::span<const Rgb> c) {
    Expanded result;
    const auto slope = [&](std::size_t i) {
        const Rgb three = c[k_vertices + i / 3];
        return i % 3 == 0 ? three.r : i % 3 == 1 ? three.g : three.b;
    };
    for (std::size_t v = 0; v < k_vertices; ++v) {
        const auto [y, co, cg] = c[v];
        result.patches[3 * v] = {y, y, y};
        for (std::size_t t = 0; t < 2; ++t) {
            const float s = slope(2 * v + t);
            result.patches[3 * v + 1 + t] = {s, s, s};
        }
        result.linear[v] = {co - cg, cg, -co - cg};
    }
    return result;
}

/// E(n) = sum A_l L_lm Y_lm(n), L_lm the harmonic coefficients of the radiance.
class DiceConvolution final : public Evaluator {
  public:
    DiceConvolution(Chroma chroma, const Rotation& dice_from_domain)
        : chroma_(chroma), dice_from_domain_(dice_from_domain) {}
    [[nodiscard]] std::string name() const override { return "convolution"; }
    [[nodiscard]] Accuracy accuracy() const override { return {"everywhere", "2e-3 of the largest E"}; }
    void signed_irradiance(std::span<const Rgb> c, DirectionView normals, MutableColourView out) const override {
        check_evaluation(chroma_ == Chroma::patches ? k_functions : k_ycocg, c, normals, out);
        const Coefficients e = convolved(c);
        for_each_part(normals, k_block_size, [&](DirectionView block, std::size_t begin) {
            harmonics_.sum(e, TurnedBlock(block, dice_from_domain_).view(), out.part(begin, block.size));
        });
    }
    [[nodiscard]] Result<ShaderCode> irradiance_code() const override {
        const auto row = [](std::size_t i) {
            constexpr std::size_t size = harmonics::coefficient_count(k_degree);
            return std::span(tables().irradiance).subspan(i * size, size);
        };
        return dice::convolution_code(chroma_, {row(0), row(1), row(2), row(k_functions), tangents_at},
                                      dice_from_domain_);
    }

  private:
    using Coefficients = std::array<Rgb, harmonics::coefficient_count(k_degree)>;

    /// Harmonic coefficients of the irradiance.
    [[nodiscard]] Coefficients convolved(std::span<const Rgb> c) const {
        Coefficients e{};
        if (chroma_ == Chroma::patches) {
            add(c, 0, e);
        } else {
            const Expanded all = expanded(c);
            add(all.patches, 0, e);
            add(all.linear, k_functions, e);
        }
        return e;
    }
    /// Adds the irradiance of functions from `first` on.
    static void add(std::span<const Rgb> c, std::size_t first, std::span<Rgb> e) {
        for (std::size_t k = 0; k < c.size(); ++k) {
            const float* row = tables().irradiance.data() + (first + k) * e.size();
            for (std::size_t i = 0; i < e.size(); ++i) e[i] = e[i] + c[k] * row[i];
        }
    }

    harmonics::Harmonics harmonics_{k_degree};
    Chroma chroma_;
    Rotation dice_from_domain_;
};

constexpr Rotation k_upright = {Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/// Dice looked up at D w before the turn are looked up at D R^T w' after it.
Rotation turned_dice(const Rotation& dice, const Rotation& r) {
    return {rotate(r, dice[0]), rotate(r, dice[1]), rotate(r, dice[2])};
}

}  // namespace

std::shared_ptr<const LinearBasis> ambient_dice() { return std::make_shared<AmbientDice>(k_upright); }

Result<std::shared_ptr<const Basis>> AmbientDice::from_name(std::string_view name) {
    if (name == "dice-bezier") return std::shared_ptr<const Basis>(std::make_shared<AmbientDice>(k_upright));
    if (name == "dice-ycocg") return std::shared_ptr<const Basis>(std::make_shared<AmbientDiceYCoCg>(k_upright));
    return std::shared_ptr<const Basis>();
}

void AmbientDice::values(DirectionView block, float* rows) const {
    clear(rows, size(), block.size);
    for (std::size_t j = 0; j < block.size; ++j) {
        const Vec3 w = rotate(dice_from_domain_, direction_at(block, j));
        const Face& face = face_of(w);
        const auto weights = patch_weights(face, w);
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t t = 0; t < 3; ++t) rows[(3 * face.corner[k] + t) * k_block_size + j] = weights[k][t];
    }
}

Result<ShaderCode> AmbientDice::radiance_code() const {
    return dice::radiance_code(Chroma::patches, dice_from_domain_);
}

std::string AmbientDice::description() const {
    return "ambient dice: values and slopes at the vertices of an icosahedron, Bezier patches between";
}

Matrix AmbientDice::gram() const {
    Matrix result(k_functions * k_functions);
    for (std::size_t i = 0; i < k_functions; ++i)
        for (std::size_t j = 0; j < k_functions; ++j)
            result[i * k_functions + j] =
                tables().products(static_cast<Eigen::Index>(std::min(i, j)), static_cast<Eigen::Index>(std::max(i, j)));
    return result;
}

std::vector<double> AmbientDice::integrals() const {
    return {tables().integrals.begin(), tables().integrals.begin() + k_functions};
}

std::shared_ptr<const Evaluator> AmbientDice::evaluator(std::string_view name) const {
    if (name != "convolution") return nullptr;
    return std::make_shared<DiceConvolution>(Chroma::patches, dice_from_domain_);
}

Basis::Rotated AmbientDice::rotated(const Rotation& r, std::span<const Rgb> c) const {
    check_equal("coefficients", c.size(), size());
    return {std::make_shared<AmbientDice>(turned_dice(dice_from_domain_, r)), {c.begin(), c.end()}};
}

void AmbientDiceYCoCg::radiance(std::span<const Rgb> c, DirectionView directions, MutableColourView out) const {
    check_evaluation(k_ycocg, c, directions, out);
    const Expanded all = expanded(c);
    for (std::size_t j = 0; j < directions.size; ++j) {
        const Vec3 w = rotate(dice_->dice_from_domain(), direction_at(directions, j));
        const Face& face = face_of(w);
        const auto weights = patch_weights(face, w);
        const auto b = barycentric(face, w);
        const float sum = b[0] + b[1] + b[2];
        Rgb radiance;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t vertex = face.corner[k];
            radiance = radiance + all.linear[vertex] * (b[k] / sum);
            for (std::size_t t = 0; t < 3; ++t) radiance = radiance + all.patches[3 * vertex + t] * weights[k][t];
        }
        set_entry(out, j, radiance);
    }
}

Result<ShaderCode> AmbientDiceYCoCg::radiance_code() const {
    return dice::radiance_code(Chroma::linear, dice_->dice_from_domain());
}

void AmbientDiceYCoCg::fit(std::span<const Rgb> accumulated, std::span<Rgb> c) const {
    check_equal("accumulated coefficients", accumulated.size(), k_functions);
    check_equal("coefficients", c.size(), k_ycocg);
    Eigen::Matrix<double, k_functions, 3> ycocg;
    for (Eigen::Index i = 0; i < ycocg.rows(); ++i) {
        const Rgb v = accumulated[static_cast<std::size_t>(i)];
        ycocg.row(i) << (v.r + 2 * v.g + v.b) / 4, (v.r - v.b) / 2, (2 * v.g - v.r - v.b) / 4;
    }
    const Eigen::Matrix<double, k_vertices, 2> chroma = tables().linear_from_patches * ycocg.rightCols<2>();
    for (std::size_t v = 0; v < k_vertices; ++v) {
        const auto row = static_cast<Eigen::Index>(v);
        c[v] = {static_cast<float>(ycocg(3 * row, 0)), static_cast<float>(chroma(row, 0)),
                static_cast<float>(chroma(row, 1))};
    }
    const auto slope = [&](std::size_t i) {
        return static_cast<float>(ycocg(static_cast<Eigen::Index>(3 * (i / 2) + 1 + i % 2), 0));
    };
    for (std::size_t i = 0; i < 8; ++i) c[k_vertices + i] = {slope(3 * i), slope(3 * i + 1), slope(3 * i + 2)};
}

std::string AmbientDiceYCoCg::description() const {
    return "ambient dice of luminance, chroma linear between the vertices";
}

std::shared_ptr<const Evaluator> AmbientDiceYCoCg::evaluator(std::string_view name) const {
    if (name != "convolution") return nullptr;
    return std::make_shared<DiceConvolution>(Chroma::linear, dice_->dice_from_domain());
}

Basis::Rotated AmbientDiceYCoCg::rotated(const Rotation& r, std::span<const Rgb> c) const {
    check_equal("coefficients", c.size(), size());
    return {std::make_shared<AmbientDiceYCoCg>(turned_dice(dice_->dice_from_domain(), r)), {c.begin(), c.end()}};
}

}  // namespace lobelia
