// Codecs: a basis, an encoder and an evaluator together, made from names such as "sg12/least-squares/hill".
#pragma once

#include <string_view>

#include "lobelia/encoder.h"
#include "lobelia/result.h"

namespace lobelia {

/// The three axes of a codec, by name.
struct CodecName {
    std::string basis, encoder, evaluator;
    [[nodiscard]] std::string str() const { return basis + "/" + encoder + "/" + evaluator; }
    friend bool operator==(const CodecName&, const CodecName&) = default;
};

/// The run-time face: batches in, batches out. Immutable; safe to share between threads.
class Codec {
  public:
    Codec(CodecName name, std::shared_ptr<const Encoder> encoder, std::shared_ptr<const Evaluator> evaluator)
        : name_(std::move(name)), encoder_(std::move(encoder)), evaluator_(std::move(evaluator)) {}

    [[nodiscard]] const CodecName& name() const { return name_; }
    [[nodiscard]] const Basis& basis() const { return encoder_->basis(); }
    [[nodiscard]] const std::shared_ptr<const Encoder>& encoder() const { return encoder_; }
    [[nodiscard]] const Evaluator& evaluator() const { return *evaluator_; }

    /// Coefficients of all samples at once.
    [[nodiscard]] std::vector<Rgb> encode(SampleView samples) const;
    /// L(w) [W/(m^2 sr)] at each direction; clamped at 0 where the evaluator clamps.
    void radiance(std::span<const Rgb> c, DirectionView directions, MutableColourView out) const;
    /// E(n) [W/m^2] at each normal.
    void irradiance(std::span<const Rgb> c, DirectionView normals, MutableColourView out) const;

  private:
    CodecName name_;
    std::shared_ptr<const Encoder> encoder_;
    std::shared_ptr<const Evaluator> evaluator_;
};

/// The lists behind every codec (codecs.cpp holds them).
[[nodiscard]] std::vector<std::string> basis_names();
/// Names beyond the list that make_basis knows, and what they mean.
struct NamePattern {
    std::string_view pattern, meaning;
};
[[nodiscard]] std::vector<NamePattern> basis_name_patterns();
[[nodiscard]] std::vector<std::string> encoder_names();
/// Further encoders known by name: published variants that are only of interest in a study.
[[nodiscard]] std::vector<std::string> encoder_variant_names();
/// Encoders that a basis is listed with: of those that it names (all, where it names none) the ones that suit it,
/// running averages and non-negative ones only where its functions are >= 0.
[[nodiscard]] std::vector<std::string> encoder_names(const Basis& basis);
/// The listed encoder whose solution this one strives for: least squares, its non-negative form, or the joint norm's.
[[nodiscard]] std::string encoder_limit(std::string_view encoder);
/// The codec for texels and probes where none is asked for: the smallest that reads irradiance well (docs/baking.md).
[[nodiscard]] std::string default_codec();
/// The sensible product of the lists.
[[nodiscard]] std::vector<CodecName> all_codecs();

/// A listed basis or any other member of the listed families, such as "sg24" or "sg:lobes.txt".
[[nodiscard]] Result<std::shared_ptr<const Basis>> make_basis(std::string_view name);
[[nodiscard]] Result<std::shared_ptr<const Encoder>> make_encoder(std::string_view name,
                                                                  std::shared_ptr<const Basis> basis);
[[nodiscard]] Result<std::shared_ptr<const Evaluator>> make_evaluator(std::string_view name, const Basis& basis);
/// The ways to read glossy reflection from a basis: its own, the most accurate last, then "sampled", which reads any.
[[nodiscard]] std::vector<std::string> specular_names(const Basis& basis);
[[nodiscard]] Result<std::shared_ptr<const SpecularEvaluator>> make_specular(std::string_view name,
                                                                             std::shared_ptr<const Basis> basis);
/// From "basis/encoder/evaluator"; the error of an unknown name lists the nearest known ones.
[[nodiscard]] Result<Codec> make_codec(std::string_view name);
/// The parts of "basis/encoder/evaluator", unchecked but for their number.
[[nodiscard]] Result<CodecName> parse_codec_name(std::string_view name);

/// The known names nearest to `name` by edit distance, nearest first, at most three, as " (did you mean ...?)"; where
/// none is near, all of a short list as " (known: ...)", or nothing.
[[nodiscard]] std::string nearest_names(std::string_view name, std::span<const std::string> known);

}  // namespace lobelia
