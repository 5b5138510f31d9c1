// OpenEXR's streams: from files and memory, into strings and staged files, with plain bounds checks.
#pragma once

#include <OpenEXR/ImfIO.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "io/read_file.h"
#include "io/staged_file.h"

namespace lobelia::io {

// OpenEXR 2 and 3 name different 64-bit types here.
using StreamPosition = decltype(std::declval<Imf::IStream&>().tellg());

/// A source of known size. `read` throws std::runtime_error if the bytes run out, as OpenEXR expects.
class ExrInput : public Imf::IStream {
  public:
    using Imf::IStream::IStream;
    [[nodiscard]] virtual std::uint64_t size() const = 0;
};

class MemoryInput final : public ExrInput {
  public:
    MemoryInput(std::span<const std::byte> bytes, const std::string& name) : ExrInput(name.c_str()), bytes_(bytes) {}
    bool read(char* target, int count) override;
    StreamPosition tellg() override { return position_; }
    void seekg(StreamPosition position) override { position_ = position; }
    [[nodiscard]] std::uint64_t size() const override { return bytes_.size(); }

  private:
    std::span<const std::byte> bytes_;
    StreamPosition position_ = 0;
};

class FileInput final : public ExrInput {
  public:
    explicit FileInput(InputFile file) : ExrInput(file.name().c_str()), file_(std::move(file)) {}
    bool read(char* target, int count) override;
    StreamPosition tellg() override { return position_; }
    /// Positions come from the file itself; those beyond its end fail at the next read.
    void seekg(StreamPosition position) override { position_ = position; }
    [[nodiscard]] std::uint64_t size() const override { return file_.size(); }

  private:
    InputFile file_;
    StreamPosition position_ = 0;
};

class MemoryOutput final : public Imf::OStream {
  public:
    explicit MemoryOutput(const std::string& name) : OStream(name.c_str()) {}
    void write(const char* source, int count) override;
    StreamPosition tellp() override { return position_; }
    void seekp(StreamPosition position) override { position_ = position; }
    [[nodiscard]] std::string take() { return std::move(bytes_); }

  private:
    std::string bytes_;
    StreamPosition position_ = 0;
};

/// Writes into a staged file. After the first failure nothing more is written, and `status` holds the error.
class StagedOutput final : public Imf::OStream {
  public:
    explicit StagedOutput(StagedFile& file) : OStream("OpenEXR file"), file_(file) {}
    void write(const char* source, int count) override;
    StreamPosition tellp() override { return position_; }
    void seekp(StreamPosition position) override;
    [[nodiscard]] const Status& status() const { return status_; }

  private:
    void require(Status status);

    StagedFile& file_;
    Status status_ = Done{};
    StreamPosition position_ = 0;
};

}  // namespace lobelia::io
