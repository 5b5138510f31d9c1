#include "shade/shader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "lobelia/specular.h"
#include "shade/probe_functions.h"
#include "shade/translate.h"

namespace lobelia::shade {
namespace {

constexpr std::array k_needs = {
    NeedInfo{Need::irradiance, "irradiance", "vec3 n", "Returns irradiance E(n) [W/m^2] at the unit normal n."},
    NeedInfo{Need::radiance, "radiance", "vec3 w", "Returns radiance L(w) [W/(m^2 sr)] from the unit direction w."},
    NeedInfo{
        Need::specular, "specular", "GgxTexels texels, vec3 n, vec3 v, float alpha, vec3 f0",
        "Returns the radiance [W/(m^2 sr)] that a GGX surface of the unit normal n reflects in the unit direction v "
        "to the\n/// viewer. alpha is the square of glTF's roughness, f0 the reflectance along the normal."},
    NeedInfo{Need::probes, "probes", {}, {}},
};

/// Returns the specular evaluator that a request names, or the most accurate one of the basis.
Result<std::shared_ptr<const SpecularEvaluator>> specular_of(const Codec& codec, const ShaderRequest& request) {
    const std::shared_ptr<const Basis> basis(codec.encoder(), &codec.basis());
    const auto names = basis->specular_names();
    if (!request.specular.empty()) return make_specular(request.specular, basis);
    if (!names.empty()) return make_specular(names.back(), basis);
    std::string others;
    for (const auto& name : basis_names())
        if (!make_basis(name).value()->specular_names().empty()) others += (others.empty() ? "" : ", ") + name;
    return Error{fmt::format("basis {} has no specular evaluator with shader code; those that have one: {}",
                             basis->name(), others)};
}

Result<ShaderCode> code_of(const Codec& codec, const ShaderRequest& request, Need need) {
    if (need == Need::radiance) return codec.basis().radiance_code();
    if (need == Need::irradiance) return codec.evaluator().irradiance_code();
    const auto evaluator = specular_of(codec, request);
    return evaluator ? specular_code(**evaluator) : evaluator.error();
}

/// Collects functions, each once.
class Functions {
  public:
    void add(const std::vector<ShaderFunction>& functions) {
        for (const ShaderFunction& f : functions)
            if (std::find(list_.begin(), list_.end(), f) == list_.end()) list_.push_back(f);
    }
    [[nodiscard]] std::string text() const {
        std::string text;
        for (const ShaderFunction& f : list_) text += f.text + "\n";
        return text;
    }

  private:
    std::vector<ShaderFunction> list_;
};

std::string function_text(Need need, const ShaderCode& code, Negative negative) {
    const NeedInfo& about = info(need);
    const bool clamped = negative == Negative::clamped && need != Need::specular;
    const std::string result = clamped ? fmt::format("max({}, vec3(0.0))", code.result) : code.result;
    return fmt::format("/// {}\nvec3 {}(Coefficients light, {}) {{\n{}    return {};\n}}\n", about.value, about.name,
                       about.parameters, code.statements, result);
}

Frame frame_of(const Codec& codec, const ShaderRequest& request) {
    return request.frame.value_or(codec.basis().domain() == Domain::hemisphere ? Frame::tangent : Frame::scene);
}

/// The rows of the frame, as tangent_from_world() in src/bake/place/tangent.cpp has them.
constexpr std::string_view k_to_tangent =
    R"(/// Returns w, a direction in the scene's frame, in the tangent frame of the unit interpolated vertex normal. The frame
/// depends on that normal alone, not on UVs (Frisvad 2012).
vec3 to_tangent(vec3 normal, vec3 w) {
    vec3 x = vec3(3.0, -6.0, 2.0) / 7.0;
    vec3 y = vec3(6.0, 2.0, -3.0) / 7.0;
    vec3 z = vec3(2.0, 3.0, 6.0) / 7.0;
    float a = dot(x, normal);
    float b = dot(y, normal);
    float along = dot(z, normal);
    // 1 + along, also where the normal is nearly -z.
    float c = choose(along > 0.0, 1.0 + along, (a * a + b * b) / (1.0 - along));
    vec3 h = (x * a + y * b) / max(c, 1.0e-12) + z;
    return vec3(dot(x - h * a, w), dot(y - h * b, w), dot(normal, w));
}
)";

/// The comment at the head of the text, without the marks of a comment.
std::string head(const Codec& codec, const ShaderRequest& request) {
    std::string text = fmt::format("{}{}, {}.\n\n", codec.name().str(),
                                   request.storage ? fmt::format(" stored as {}", request.storage->name) : "",
                                   shade::info(request.language).description);
    text += fmt::format("Basis: {}.\n", codec.basis().description());
    const auto state = [&](std::string_view what, const std::string& name, const Accuracy& accuracy) {
        text += fmt::format("{}: {}; valid: {}; largest error: {}.\n", what, name, accuracy.range, accuracy.error);
    };
    for (const Need need : request.needs) {
        if (need == Need::irradiance) state("Irradiance", codec.evaluator().name(), codec.evaluator().accuracy());
        if (need != Need::specular) continue;
        if (const auto evaluator = specular_of(codec, request))
            state("Specular", (*evaluator)->name(), (*evaluator)->accuracy());
    }
    if (request.storage) text += fmt::format("Storage: {}.\n", request.storage->description);
    text +=
        frame_of(codec, request) == Frame::tangent
            ? "Directions are unit vectors in the tangent frame, see to_tangent(), and point away from the surface. "
              "Without a\nnormal map the normal is (0, 0, 1).\n"
            : "Directions are unit vectors in the scene's frame (right-handed), and point away from the surface.\n";
    const auto has = [&](Need need) { return std::count(request.needs.begin(), request.needs.end(), need) > 0; };
    if (has(Need::irradiance))
        text += "Irradiance is not divided by pi: a Lambertian surface reflects albedo * E / pi.\n";
    if (has(Need::specular))
        text +=
            "specular() needs the texture of lobelia shader --table, sampled at ggx_coordinates() with linear "
            "filtering, "
            "clamped.\nIncluded are masking, shadowing and the cosine of light.\n";
    return text;
}

/// Breaks lines of more than 120 columns.
std::string as_comment(const std::string& text) {
    constexpr std::size_t k_columns = 117;
    std::string comment;
    for (std::size_t begin = 0; begin < text.size();) {
        std::size_t end = std::min(text.find('\n', begin), text.size());
        if (end - begin > k_columns) end = std::min(end, text.rfind(' ', begin + k_columns));
        comment += "//";
        if (end > begin) comment += " " + text.substr(begin, end - begin);
        comment += "\n";
        begin = end + 1;
    }
    return comment;
}

}  // namespace

std::span<const NeedInfo> needs() { return k_needs; }

const NeedInfo& info(Need need) { return k_needs[static_cast<std::size_t>(need)]; }

Result<std::string> shader_text(const Codec& codec, const ShaderRequest& request) {
    Functions functions;
    std::string source = fmt::format(
        "/// The coefficients of one place.\nstruct Coefficients {{\n    vec3 c[{}];\n}};\n\n", codec.basis().size());
    std::string last;

    if (frame_of(codec, request) == Frame::tangent) functions.add({{"to_tangent", std::string(k_to_tangent)}});

    // Unpack sampled values.
    if (request.storage) {
        const CoefficientTraits traits = coefficient_traits(*codec.encoder());
        if (!suits(*request.storage, traits))
            return find_storages(std::vector{std::string(request.storage->name)}, traits).error();
        const UnpackCode unpack = unpack_code(request.storage->layout(traits));
        functions.add(unpack.functions);
        source += unpack.texel + "\n";
        last += "/// Returns the coefficients of a texel.\nCoefficients unpack(Texel t) {\n" + unpack.body + "}\n\n";
    }

    // Evaluate coefficients.
    for (const Need need : request.needs) {
        if (need == Need::probes) {
            if (codec.basis().domain() != Domain::sphere)
                return Error{codec.basis().name() + " is a basis over the hemisphere, and probes need the sphere"};
            functions.add(probe_functions());
            continue;
        }
        const auto code = code_of(codec, request, need);
        if (!code) return code.error();
        functions.add(code->functions);
        last += function_text(need, *code, codec.evaluator().negative()) + "\n";
    }

    auto text = translate(source + functions.text() + last, request.language);
    if (!text) return text.error();
    while (text->ends_with("\n\n")) text->pop_back();
    return as_comment(head(codec, request)) + "\n" + *text;
}

}  // namespace lobelia::shade
