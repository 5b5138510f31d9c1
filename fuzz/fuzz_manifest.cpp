// Feeds any bytes to the readers of bake.json and probes.json. See CMakeLists.txt for how to run it.
#include "bake/write/manifest.h"
#include "bake/write/probe_files.h"
#include "check_loaded.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lobelia;
    const std::string_view text = text_of(data, size);
    const auto manifest = manifest_from_json(text, "fuzz");
    if (check_result(manifest)) {
        // Check that data read from the input survives writing and reading again.
        const std::string again = to_json_text(*manifest);
        const auto second = manifest_from_json(again, "again");
        require(static_cast<bool>(second) && to_json_text(*second) == again);
        for (const auto& page : manifest->pages) require(page.file.find('/') == std::string::npos);
    }
    const auto probes = probes_from_json(text, "fuzz");
    if (check_result(probes)) require(probes->probes.size() > 0 && probes->file.find('/') == std::string::npos);
    return 0;
}
