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

/// Encodes samples and evaluates coefficients, in batches or at one direction. Immutable; safe to share between
/// threads.
class Codec {
  public:
    Codec(CodecName name, std::shared_ptr<const Encoder> encoder, std::shared_ptr<const Evaluator> evaluator)
        : name_(std::move(name)),
          encoder_(std::move(encoder)),
          evaluator_(std::move(evaluator)),
          negative_(evaluator_->negative()) {}

    [[nodiscard]] const CodecName& name() const { return name_; }
    [[nodiscard]] const Basis& basis() const { return encoder_->basis(); }
    [[nodiscard]] const std::shared_ptr<const Encoder>& encoder() const { return encoder_; }
    [[nodiscard]] const Evaluator& evaluator() const { return *evaluator_; }

    /// Coefficients of all samples at once.
    [[nodiscard]] std::vector<Rgb> encode(SampleView samples) const;
    /// L(w) [W/(m^2 sr)] at each direction, or at one; clamped at 0 where the evaluator clamps.
    void radiance(std::span<const Rgb> c, DirectionView directions, MutableColourView out) const;
    [[nodiscard]] Rgb radiance(std::span<const Rgb> c, Vec3 direction) const;
    /// E(n) [W/m^2] at each normal, or at one.
    void irradiance(std::span<const Rgb> c, DirectionView normals, MutableColourView out) const;
    [[nodiscard]] Rgb irradiance(std::span<const Rgb> c, Vec3 normal) const;

  private:
    CodecName name_;
    std::shared_ptr<const Encoder> encoder_;
    std::shared_ptr<const Evaluator> evaluator_;
    Negative negative_;
};

// ---- From names. No name opens a file, so names may come from untrusted files. ----

/// A listed basis or any other member of the listed families, such as "sg24"; see basis_name_patterns().
[[nodiscard]] Result<std::shared_ptr<const Basis>> make_basis(std::string_view name);
[[nodiscard]] Result<std::shared_ptr<const Encoder>> make_encoder(std::string_view name,
                                                                  std::shared_ptr<const Basis> basis);
[[nodiscard]] Result<std::shared_ptr<const Evaluator>> make_evaluator(std::string_view name, const Basis& basis);
/// A basis's own specular evaluators, the most accurate last, then "sampled", which works for every basis.
[[nodiscard]] std::vector<std::string> specular_names(const Basis& basis);
[[nodiscard]] Result<std::shared_ptr<const SpecularEvaluator>> make_specular(std::string_view name,
                                                                             std::shared_ptr<const Basis> basis);
/// From "basis/encoder/evaluator"; the error of an unknown name lists the nearest known ones.
[[nodiscard]] Result<Codec> make_codec(std::string_view name);
/// The same of a basis made by one of the functions of bases.h.
[[nodiscard]] Result<Codec> make_codec(const std::shared_ptr<const Basis>& basis, std::string_view encoder,
                                       std::string_view evaluator);
/// The parts of "basis/encoder/evaluator", unchecked but for their number.
[[nodiscard]] Result<CodecName> parse_codec_name(std::string_view name);
/// The known names nearest to `name` by edit distance, nearest first, at most three, as " (did you mean ...?)"; where
/// none is near, all of a short list as " (known: ...)", or nothing.
[[nodiscard]] std::string nearest_names(std::string_view name, std::span<const std::string> known);

// ---- The lists behind every codec (src/core/codec/catalogue.cpp). ----

[[nodiscard]] std::vector<std::string> basis_names();
/// Names beyond the list that make_basis accepts, and their meaning.
struct NamePattern {
    std::string_view pattern, meaning;
};
[[nodiscard]] std::vector<NamePattern> basis_name_patterns();
/// Known facts about a family of bases, beside its code: for docs/bases.md, for the list of codecs and for tests.
struct BasisCard {
    std::string_view family;   ///< the title of its section
    std::string_view formula;  ///< how coefficients give radiance
    std::string_view good_at, bad_at;
    /// Largest |E / pi - 1| of the best fit to a constant radiance of 1, evaluated exactly, at normals that see only
    /// the domain.
    double furnace_bias = 0.005;
    /// Encoders with which the family is listed, separated by spaces; none: all compatible ones of a linear basis,
    /// "moments least-squares" of a fitted one. Others work, too.
    std::string_view encoders = {};
};
/// The card of the family that a basis belongs to; an empty one for bases outside of the list.
[[nodiscard]] const BasisCard& card_of(const Basis& basis);

[[nodiscard]] std::vector<std::string> encoder_names();
/// Further encoders known by name: published variants that are only of interest in a study.
[[nodiscard]] std::vector<std::string> encoder_variant_names();
/// Encoders that a basis is listed with: those of its card that are compatible. Running averages and non-negative ones
/// need functions >= 0.
[[nodiscard]] std::vector<std::string> encoder_names(const Basis& basis);
/// The listed encoder whose solution this one converges to: least squares, its non-negative form, or the joint norm's.
[[nodiscard]] std::string encoder_limit(std::string_view encoder);
/// The default codec for texels and probes: the smallest with accurate irradiance (docs/baking.md).
[[nodiscard]] std::string default_codec();
/// The sensible product of the lists.
[[nodiscard]] std::vector<CodecName> all_codecs();

}  // namespace lobelia
