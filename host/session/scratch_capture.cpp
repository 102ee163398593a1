#include "session/scratch_capture.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik {
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

}  // namespace

ScratchCapture encode_to_scratch(const SourceRequest& source, const MemoryBudget& memory,
                                 const NeedsOfFormat& rendering, const ReportedProgress& progress,
                                 std::stop_token stop) {
  ClipSource clip = open_clip_source(source, memory);  // before a folder is made for it
  const ClipMemory shares = memory_for_encoding(memory, clip.read_clip(), rendering(clip.capture));
  const PrivateFolder folder;
  // Quick to unpack: it is read many times and kept for no longer than that.
  const EncodeRequest request{folder.path() / "capture.tik", {tik::CodecId::lz4, 0}};
  Encoded encoded = encode(std::move(clip), request, shares, progress, std::move(stop));
  return {std::make_unique<tik::Reader>(request.output), std::move(encoded)};
}

}  // namespace nutik
