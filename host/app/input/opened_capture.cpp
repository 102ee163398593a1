#include "app/input/opened_capture.hpp"

#include <unistd.h>

#include <filesystem>

#include "app/input/capture_input.hpp"
#include "app/input/encoding.hpp"
#include "capture/format.hpp"

namespace nutik::app {
namespace {

namespace fs = std::filesystem;

// Removes a file that is still open elsewhere: what was opened stays readable.
struct RemovedAtEnd {
  fs::path path;
  explicit RemovedAtEnd(fs::path file) : path(std::move(file)) {}
  ~RemovedAtEnd() {
    std::error_code ignored;
    fs::remove(path, ignored);
  }
  RemovedAtEnd(const RemovedAtEnd&) = delete;
  RemovedAtEnd& operator=(const RemovedAtEnd&) = delete;
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
  const RemovedAtEnd scratch(fs::temp_directory_path() / format("nutik-{}.tik", ::getpid()));
  Encoding encoding(std::move(source), source_options, tik::Codec::parse(kScratchCodec), name, scratch.path);
  Progress progress("reading", announced, options.quiet);
  const Timeline timeline = encoding.run(progress);
  reader_ = std::make_unique<tik::Reader>(scratch.path);
  notes_.push_back(format("source: {}", timing_text(timeline, source_options)));
  for (const std::string& note : notes) notes_.push_back(format("note: {}", note));
  if (const std::string note = slow_motion_note(timeline, source_options); !note.empty()) {
    notes_.push_back(format("note: {}", note));
  }
}

}  // namespace nutik::app
