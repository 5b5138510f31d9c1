// Feeds any bytes to the readers of a bake's JSON files. See CMakeLists.txt for how to run it.
#include "bake/write/manifest.h"
#include "bake/write/probe_files.h"
#include "check_loaded.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lobelia;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    // A codec's name may name a file of lobes; skip those, because this target tests the JSON readers.
    if (text.find(":/") != std::string_view::npos || text.find("sg:") != std::string_view::npos) return 0;
    const auto manifest = manifest_from_json(text, "fuzz");
    if (manifest) {
        // Check that data read from the input survives writing and reading again.
        const std::string again = to_json_text(*manifest);
        const auto second = manifest_from_json(again, "again");
        require(static_cast<bool>(second) && to_json_text(*second) == again);
        for (const auto& page : manifest->pages) require(page.file.find('/') == std::string::npos);
    } else {
        require(!manifest.error().message.empty());
    }
    const auto probes = probes_from_json(text, "fuzz");
    if (probes)
        require(probes->probes.size() > 0 && probes->file.find('/') == std::string::npos);
    else
        require(!probes.error().message.empty());
    return 0;
}
