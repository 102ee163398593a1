#include "app/input/opened_capture.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "app/input/capture_input.hpp"
#include "app/input/encoding.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik::app {
namespace {

namespace fs = std::filesystem;

// A folder that nobody else can reach into, removed with its files: what was opened stays readable.
class PrivateFolder {
 public:
  PrivateFolder() {
    std::string name = fs::temp_directory_path() / "nutik-XXXXXX";
    if (::mkdtemp(name.data()) == nullptr) {
      throw OutputError(format("no temporary folder can be made: {}: {}", name, std::strerror(errno)));
    }
    path_ = name;
  }
  ~PrivateFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// Quick to unpack; it is read many times and kept for no longer than that.
constexpr const char* kScratchCodec = "lz4";

}  // namespace

OpenedCapture::OpenedCapture(const std::string& name, const Options& options) {
  if (is_tik(name)) {
    refuse_source_options(options, name);
    reader_ = std::make_unique<tik::Reader>(name);
  } else {
    encode(name, options);
  }
}

void OpenedCapture::encode(const std::string& name, const Options& options) {
  const SourceOptions source_options = SourceOptions::from(options);
  SourceClip source = open_source(name, source_options);
  const std::uint64_t announced = source.clip->info().sample_count;
  const std::vector<std::string> notes = source.notes;
  const PrivateFolder folder;
  const fs::path scratch = folder.path() / "capture.tik";
  Encoding encoding(std::move(source), source_options, tik::Codec::parse(kScratchCodec), name, scratch);
  Progress progress("reading", announced, options.quiet);
  const Timeline timeline = encoding.run(progress);
  reader_ = std::make_unique<tik::Reader>(scratch);
  notes_.push_back(format("source: {}", timing_text(timeline, source_options)));
  for (std::string& line : note_lines(notes, timeline, source_options)) notes_.push_back(std::move(line));
}

}  // namespace nutik::app
