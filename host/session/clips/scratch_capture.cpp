#include "session/clips/scratch_capture.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <optional>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "imev/expected_values.hpp"
#include "system/temporary_folder.hpp"

namespace nutik {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPrefix = "nutik-";

// A folder's lock, which ends with its process, however that ends.
class FolderLock {
 public:
  explicit FolderLock(const fs::path& folder)
      : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC)) {}
  ~FolderLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  bool take() const { return descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0; }
  // Since when its files have been as they are; nothing where it is not ours.
  [[nodiscard]] std::optional<std::time_t> changed_s() const {
    struct stat status {};
    if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0 || status.st_uid != ::geteuid()) return {};
    return status.st_mtim.tv_sec;
  }

 private:
  int descriptor_;
};

// Removes what processes left behind that were killed. A new folder is not locked at once: it is left alone for a
// while.
void remove_abandoned_folders(const fs::path& where) {
  constexpr std::time_t kNewSeconds = 60;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(where, ignored)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(kPrefix) || name.size() != std::strlen(kPrefix) + 6) continue;
    const FolderLock lock(entry.path());
    const auto changed_s = lock.changed_s();
    if (changed_s && *changed_s + kNewSeconds < std::time(nullptr) && lock.take())
      fs::remove_all(entry.path(), ignored);
  }
}

// A folder that nobody else can reach into, removed with its files: what was opened stays readable.
class PrivateFolder {
 public:
  PrivateFolder() {
    remove_abandoned_folders(temporary_folder());
    std::string name = temporary_folder() / (std::string(kPrefix) + "XXXXXX");
    if (::mkdtemp(name.data()) == nullptr) {
      throw OutputError(format("no temporary folder can be made: {}: {}", name, std::strerror(errno)));
    }
    path_ = name;
    lock_.emplace(path_);
    lock_->take();
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
  std::optional<FolderLock> lock_;
};

// Whether there is plenty of room for a capture that is not packed: it is read many times, and kept for no longer than
// that. A packed one is quick to unpack.
bool has_room_for(const ClipSource& clip, const fs::path& folder) {
  constexpr double kMaxOfRoom = 0.25;
  std::error_code error;
  const fs::space_info space = fs::space(folder, error);
  const std::uint64_t samples = clip.announced_samples();
  return !error && samples > 0 &&
         static_cast<double>(samples) * static_cast<double>(held_format(clip.capture).sample_bytes()) <=
             kMaxOfRoom * static_cast<double>(space.available);
}

}  // namespace

ScratchCapture encode_to_scratch(const SourceRequest& source, const OpenClip& open,
                                 const MemoryBudget& memory, const NeedsOfFormat& rendering,
                                 const ReportedProgress& progress, std::stop_token stop) {
  const TwofoldProgress twofold(source, progress);
  // Before a folder is made for it.
  ClipSource clip = open ? open_clip_source(source, open, memory, twofold.finding, stop)
                         : open_clip_source(source, memory, twofold.finding, stop);
  const ClipMemory shares = memory_for_encoding(memory, clip.clip_to_read(), rendering(clip.capture));
  const PrivateFolder folder;
  const EncodeRequest request{folder.path() / "capture.tik",
                              {has_room_for(clip, folder.path()) ? tik::CodecId::none : tik::CodecId::lz4, 0},
                              OutputFile::Lasting::no};
  EncodedCapture encoded = encode(std::move(clip), request, shares, twofold.reading, std::move(stop));
  return {std::make_unique<tik::Reader>(request.output), std::move(encoded)};
}

}  // namespace nutik
