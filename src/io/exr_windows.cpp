// Data window and display window of OpenEXR, after "Technical Introduction to OpenEXR" (openexr.com).
#include "io/exr_windows.h"

#include <fmt/format.h>

namespace lobelia::io {

namespace {

ExrWindow window_of(const Imath::Box2i& box) {
    return {box.min.x, box.min.y, std::int64_t{box.max.x} + 1, std::int64_t{box.max.y} + 1};
}

}  // namespace

ExrWindow data_window(const Imf::Header& header) { return window_of(header.dataWindow()); }
ExrWindow display_window(const Imf::Header& header) { return window_of(header.displayWindow()); }

ExrWindow common_window(const ExrWindow& a, const ExrWindow& b) {
    return {std::max(a.left, b.left), std::max(a.top, b.top), std::min(a.right, b.right), std::min(a.bottom, b.bottom)};
}

std::vector<std::string> warnings_about_windows(const Imf::Header& header) {
    const ExrWindow data = data_window(header), display = display_window(header);
    const ExrWindow common = common_window(data, display);
    std::vector<std::string> warnings;
    if (common != display)
        warnings.push_back(
            fmt::format("only {} x {} of the {} x {} pixels are stored (the data window is smaller than the display "
                        "window); the others are black",
                        common.width(), common.height(), display.width(), display.height()));
    if (common != data)
        warnings.push_back(
            fmt::format("{} stored pixels outside the display window were ignored", data.pixels() - common.pixels()));
    return warnings;
}

}  // namespace lobelia::io
