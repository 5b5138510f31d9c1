// A bake as a folder, written together and read again.
#include "baker/output/bake_folder.h"

#include <fmt/format.h>

#include "baker/output/page_files.h"
#include "baker/output/probe_files.h"
#include "io/staged_file.h"

namespace lobelia {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_probes_name = "probes.json";
constexpr const char* k_probe_coefficients_name = "probes.bin";

/// Files that are all complete before the first takes its place.
class FilesTogether {
  public:
    explicit FilesTogether(fs::path folder) : folder_(std::move(folder)) {}

    /// Fills a file by `write(staged file)`.
    template <class Write>
    Status add(const std::string& name, const Write& write) {
        auto file = StagedFile::create(folder_ / name);
        if (!file) return file.error();
        if (auto status = write(*file); !status) return status;
        if (auto status = file->flush(); !status) return status;
        files_.push_back(*std::move(file));
        return Done{};
    }
    Status add_text(const std::string& name, std::string_view text) {
        return add(name, [&](StagedFile& file) { return file.write(std::as_bytes(std::span(text))); });
    }
    /// In the order in which they were added.
    Status commit() {
        for (auto& file : files_)
            if (auto status = file.commit(); !status) return status;
        return Done{};
    }

  private:
    fs::path folder_;
    std::vector<StagedFile> files_;
};

Status write_all(FilesTogether& files, const Bake& bake) {
    Manifest manifest = bake.manifest;
    manifest.pages.clear();
    for (std::size_t i = 0; i < bake.pages.size(); ++i) {
        const std::string& name = manifest.pages.emplace_back(BakedPage{fmt::format("page-{}.exr", i), {}}).file;
        auto status = files.add(name, [&](StagedFile& file) {
            return write_page(file, bake.pages[i], bake.layout(), bake.normals[i], {manifest.precision});
        });
        if (!status) return status;
    }
    manifest.probes.reset();
    if (bake.probes) {
        manifest.probes = k_probes_name;
        auto status = files.add(k_probe_coefficients_name,
                                [&](StagedFile& file) { return write_probe_coefficients(file, *bake.probes); });
        if (status) status = files.add_text(k_probes_name, to_json_text(*bake.probes, k_probe_coefficients_name));
        if (!status) return status;
    }
    return files.add_text(k_manifest_name, to_json_text(manifest));
}

}  // namespace

Status write_bake(const fs::path& folder, const Bake& bake) {
    assert(bake.pages.size() == bake.normals.size());
    std::error_code code;
    const bool made = fs::create_directories(folder, code);
    if (code) return Error{fmt::format("{}: cannot be made a folder: {}", folder.string(), code.message())};
    Status status = [&]() -> Status {
        FilesTogether files(folder);
        auto written = write_all(files, bake);
        return written ? files.commit() : written;
    }();
    if (!status && made) fs::remove(folder, code);
    return status;
}

Result<Bake> read_bake(const fs::path& path) {
    auto manifest = read_manifest(path);
    if (!manifest) return manifest.error();
    std::error_code code;
    const fs::path folder = fs::is_directory(path, code) ? path : path.parent_path();
    Bake bake{*std::move(manifest), {}, {}, {}};
    for (const auto& baked : bake.manifest.pages) {
        auto page = read_page(folder / baked.file, bake.layout(), bake.manifest.width, bake.manifest.height);
        if (!page) return page.error();
        bake.pages.push_back(std::move(page->page));
        bake.normals.push_back(std::move(page->normals));
    }
    if (bake.manifest.probes) {
        auto probes = read_probes(folder / *bake.manifest.probes);
        if (!probes) return probes.error();
        bake.probes = *std::move(probes);
    }
    return bake;
}

}  // namespace lobelia
