// The codec of a bake, and the feeding of its encoder.
#include "bake/gather/encoding.h"

namespace lobelia {

Result<BakeEncoding> BakeEncoding::make(const BakeOptions& options) {
    BakeEncoding result;
    const bool by_samples = options.shard.by == Shard::By::samples;
    if (by_samples && options.target_error)
        return Error{
            "--target-error cannot be combined with shards of samples: no shard knows the errors of the others"};
    if (options.codec.empty()) return result;
    auto codec = make_codec(options.codec);
    if (!codec) return codec.error();
    if (by_samples && codec->encoder()->merging() != Merging::exact)
        return Error{"codec \"" + options.codec +
                     "\": its encoder depends on the order of samples, so shards of samples cannot be merged; "
                     "shard by tiles, or use an encoder of moments"};
    if (codec->basis().domain() == Domain::sphere) result.frame_ = options.frame;
    result.codec_.emplace(*std::move(codec));
    return result;
}

const Encoder* BakeEncoding::page_encoder() const {
    if (!codec_) return nullptr;
    const FittedBasis* fitted = codec_->basis().fitted();
    return fitted != nullptr && fitted->is_continuous() ? &encoder()->accumulating() : encoder();
}

const FittedBasis* BakeEncoding::fitted_last() const {
    if (!codec_ || &page_encoder()->basis() == &codec_->basis()) return nullptr;
    return codec_->basis().fitted();
}

PageChannels BakeEncoding::page_channels() const { return {codec_ ? page_encoder()->basis().size() : 0}; }

PassOptions BakeEncoding::pass_options(const BakeOptions& options, std::uint32_t pass) const {
    PassOptions result;
    result.gather.directions = options.directions;
    if (codec_ && codec_->basis().domain() == Domain::sphere) result.gather.dark_below = Switch::on;
    result.gather.frame = frame_;
    result.samples = {pass * options.samples_per_pass, options.samples_per_pass};
    result.target_error = options.target_error;
    return result;
}

}  // namespace lobelia
