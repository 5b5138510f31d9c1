// The bake: passes of samples into one encoder state for each texel, progressive, resumable, the same at any number of
// threads; then coefficients on pages.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "bake/gather/gather.h"
#include "bake/place/atlas.h"
#include "bake/solve/pages.h"
#include "lobelia/codec.h"
#include "lobelia/result.h"

namespace lobelia {

/// In which frame a basis over the sphere stands at a texel; hemispheres always stand in the tangent frame.
enum class Frame { tangent, world };

/// One part of a bake that several machines share: part `index` of `count`.
struct Shard {
    enum class By { tiles, samples } by = By::tiles;
    std::uint32_t index = 0, count = 1;
    friend bool operator==(const Shard&, const Shard&) = default;
};

struct BakeOptions {
    std::string codec = default_codec();  ///< empty: plain irradiance at the shading normal
    Frame frame = Frame::world;
    AtlasOptions atlas;
    PathOptions paths;
    DirectionChoice directions = DirectionChoice::uniform;
    Switch push_out = Switch::on;
    std::uint32_t samples = 256;                ///< for each texel; rounded up to whole passes
    std::uint32_t samples_per_pass = 16;        ///< a multiple of k_lanes
    std::optional<double> most_seconds;         ///< end after the pass that reaches it
    std::optional<double> target_error;         ///< a texel is done when its relative standard error of E is below this
    std::size_t memory = std::size_t{2} << 30;  ///< bytes for states and pages
    unsigned threads = 0;                       ///< 0: all processors
    Shard shard;
    std::optional<std::string> only_object;  ///< bake this object's texels alone
    std::filesystem::path checkpoint;        ///< a folder; empty: none
};

/// What is known while it runs and after.
struct BakeStatistics {
    std::size_t texels = 0;          ///< covered
    std::size_t invalid_texels = 0;  ///< validity below one half
    std::size_t buried_texels = 0;   ///< of them, those that lie under other surfaces, where no light can come
    std::uint64_t rays = 0;
    double seconds = 0;         ///< tracing and encoding, over all sessions
    std::uint32_t samples = 0;  ///< of each texel, at most
    double mean_error = 0;  ///< RMS over texels of the standard error of E's luminance, over the mean of E's luminance
    double back_face_share =
        0;                      ///< of the paths of texels that are not buried, those that met a back face first: leaks
    double negative_share = 0;  ///< of the irradiances that the coefficients give over the hemisphere about each normal
    double ringing = 0;         ///< mean of their negative parts over their mean
    double codec_error = 0;     ///< RMS over texels of E by the codec minus E by the paths, over the mean of E
};

struct BakePlan;
class SiteLayout;

struct BakeProgress {
    double done = 0;  ///< of all passes of all regions, in [0, 1]
    double rays_per_second = 0;
    double seconds_left = 0;
    double error = 0;  ///< mean_error of the region after its last pass; 0: not known yet
    std::uint32_t pass = 0, passes = 0;
};
using BakeProgressSink = std::function<void(const BakeProgress&)>;

class Baker {
  public:
    /// Lays out the atlas and checks that codec, memory and options go together. The scene must outlive the bake.
    [[nodiscard]] static Result<std::unique_ptr<Baker>> make(const Scene& scene, const BakeOptions& options);
    ~Baker();

    /// Runs all passes that are missing, and solves. Where options.checkpoint holds states of this very bake they are
    /// continued if `resume`, else they are an error. `stop` ends the run at once: what the last checkpoint holds
    /// stays.
    enum class Start { fresh, resume };
    [[nodiscard]] Status run(Start start, const std::atomic<bool>& stop, const BakeProgressSink& progress = {});

    [[nodiscard]] const BakeOptions& options() const;
    [[nodiscard]] const Atlas& atlas() const;
    [[nodiscard]] const TexelMap& texels() const;
    [[nodiscard]] const PathTracer& tracer() const;
    [[nodiscard]] const Codec* codec() const;  ///< null for plain irradiance
    /// Whose coefficients pages() hold; null for plain irradiance. The codec's basis, but where that is fitted from
    /// another: what it is fitted from, for the finishing steps ask for what is linear in the light, and fit_pages() is
    /// the last of them. A basis whose fits are not continuous is fitted at once: there is no finishing it, and what it
    /// accumulates is large.
    [[nodiscard]] const Basis* page_basis() const;
    [[nodiscard]] PageLayout layout() const;
    /// Whether directions of the coefficients are in the tangent frame of each texel.
    [[nodiscard]] bool in_tangent_frame() const;
    [[nodiscard]] const SiteLayout& sites() const;  ///< what is kept for each texel while it runs
    [[nodiscard]] const BakePlan& plan() const;
    [[nodiscard]] std::uint64_t hash() const;  ///< state_hash of this bake
    /// Valid after a run without error.
    [[nodiscard]] std::vector<Page>& pages();
    [[nodiscard]] const BakeStatistics& statistics() const;

  private:
    Baker();
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// A hash of all that the states depend on: scene, codec, atlas, paths. Not of how many samples there are.
[[nodiscard]] std::uint64_t state_hash(const Scene& scene, const BakeOptions& options);

}  // namespace lobelia
