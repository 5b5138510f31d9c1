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

    /// Encodes all samples at once.
    [[nodiscard]] std::vector<Rgb> encode(SampleView samples) const;
    /// Evaluates L(w) [W/(m^2 sr)] at each direction, or at one; clamped at 0 if the evaluator clamps.
    void radiance(std::span<const Rgb> c, DirectionView directions, MutableColourView out) const;
    [[nodiscard]] Rgb radiance(std::span<const Rgb> c, Vec3 direction) const;
    /// Evaluates E(n) [W/m^2] at each normal, or at one.
    void irradiance(std::span<const Rgb> c, DirectionView normals, MutableColourView out) const;
    [[nodiscard]] Rgb irradiance(std::span<const Rgb> c, Vec3 normal) const;

  private:
    CodecName name_;
    std::shared_ptr<const Encoder> encoder_;
    std::shared_ptr<const Evaluator> evaluator_;
    Negative negative_;
};

// ---- Codecs and their parts by name. No name opens a file, so names may come from untrusted files. ----

/// Makes a listed basis or any other member of the listed families, such as "sg24"; see basis_name_patterns().
[[nodiscard]] Result<std::shared_ptr<const Basis>> make_basis(std::string_view name);
[[nodiscard]] Result<std::shared_ptr<const Encoder>> make_encoder(std::string_view name,
                                                                  std::shared_ptr<const Basis> basis);
[[nodiscard]] Result<std::shared_ptr<const Evaluator>> make_evaluator(std::string_view name, const Basis& basis);
/// Names of a basis's own specular evaluators, the most accurate last, then "sampled", which works for every basis.
[[nodiscard]] std::vector<std::string> specular_names(const Basis& basis);
[[nodiscard]] Result<std::shared_ptr<const SpecularEvaluator>> make_specular(std::string_view name,
                                                                             std::shared_ptr<const Basis> basis);
/// Makes a codec from "basis/encoder/evaluator". Errors: an unknown name; the message suggests the nearest.
[[nodiscard]] Result<Codec> make_codec(std::string_view name);
/// Makes a codec from a basis made by one of the functions of bases.h.
[[nodiscard]] Result<Codec> make_codec(const std::shared_ptr<const Basis>& basis, std::string_view encoder,
                                       std::string_view evaluator);
/// Splits "basis/encoder/evaluator"; checks only the number of parts.
[[nodiscard]] Result<CodecName> parse_codec_name(std::string_view name);
/// Returns the known names nearest to `name` by edit distance, at most three, as " (did you mean ...?)"; if none is
/// near, all names of a short list as " (known: ...)", or "".
[[nodiscard]] std::string nearest_names(std::string_view name, std::span<const std::string> known);

// ---- The lists behind every codec (src/core/codec/catalogue.cpp). ----

[[nodiscard]] std::vector<std::string> basis_names();
/// Names beyond the list that make_basis accepts, and their meaning.
struct NamePattern {
    std::string_view pattern, meaning;
};
[[nodiscard]] std::vector<NamePattern> basis_name_patterns();
/// Known facts about a family of bases, kept beside its code: for docs/bases.md, for the list of codecs and for tests.
struct BasisCard {
    std::string_view family;   ///< title of its section
    std::string_view formula;  ///< radiance as a function of the coefficients
    std::string_view good_at, bad_at;
    /// Largest |E / pi - 1| of the best fit to a constant radiance of 1, evaluated exactly, at normals that see only
    /// the domain.
    double furnace_bias = 0.005;
    /// Encoders with which the family is listed, separated by spaces; empty: all compatible ones of a linear basis,
    /// "moments least-squares" of a fitted one. Other encoders work, too.
    std::string_view encoders = {};
};
/// Returns the card of the family that a basis belongs to; an empty one for bases outside the list.
[[nodiscard]] const BasisCard& card_of(const Basis& basis);

[[nodiscard]] std::vector<std::string> encoder_names();
/// Returns further encoders known by name: published variants, of interest only in a study.
[[nodiscard]] std::vector<std::string> encoder_variant_names();
/// Returns the encoders that a basis is listed with: the compatible ones of its card. Running averages and non-negative
/// encoders need functions >= 0.
[[nodiscard]] std::vector<std::string> encoder_names(const Basis& basis);
/// Returns the listed encoder whose solution this one converges to: least squares, its non-negative form, or the joint
/// norm's.
[[nodiscard]] std::string encoder_limit(std::string_view encoder);
/// The default codec for texels and probes: the smallest with accurate irradiance (docs/baking.md).
[[nodiscard]] std::string default_codec();
/// Returns all listed combinations of basis, encoder and evaluator.
[[nodiscard]] std::vector<CodecName> all_codecs();

}  // namespace lobelia
