// How a bake encodes its light: the codec, the frame of its coefficients, and the encoder whose coefficients the pages
// hold until they are finished.
#pragma once

#include <optional>

#include "bake/gather/pass.h"
#include "lobelia/bake_job.h"
#include "lobelia/lightmap.h"

namespace lobelia {

class BakeEncoding {
  public:
    /// Errors: an unknown codec, or one whose encoder cannot be divided into shards of samples.
    [[nodiscard]] static Result<BakeEncoding> make(const BakeOptions& options);

    [[nodiscard]] const Codec* codec() const { return codec_ ? &*codec_ : nullptr; }  ///< null: irradiance only
    [[nodiscard]] const Encoder* encoder() const { return codec_ ? codec_->encoder().get() : nullptr; }
    /// The encoder whose coefficients the pages hold before the last finishing step; null: irradiance only. It differs
    /// from encoder() for bases that are fitted to another one, because the finishing steps require coefficients that
    /// are linear in the light. A basis whose fits are not continuous is fitted at once: its pages cannot be finished
    /// anyway, and its accumulated state is large.
    [[nodiscard]] const Encoder* page_encoder() const;
    /// The basis to fit finished pages to; null where they hold the codec's coefficients already.
    [[nodiscard]] const FittedBasis* fitted_last() const;
    [[nodiscard]] PageChannels page_channels() const;
    [[nodiscard]] StateLayout states() const { return StateLayout(encoder()); }
    [[nodiscard]] Frame frame() const { return frame_; }  ///< of the coefficients; tangent for plain irradiance
    [[nodiscard]] PassOptions pass_options(const BakeOptions& options, std::uint32_t pass) const;

  private:
    std::optional<Codec> codec_;
    Frame frame_ = Frame::tangent;
};

}  // namespace lobelia
