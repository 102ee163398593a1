#include "system/output_file.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "system/is_absent.hpp"
#include "system/linux_calls.hpp"
#include "capture/source_text.hpp"
#include "system/reused_entries.hpp"
#include "system/shared_state.hpp"
#include "system/temporary_folder.hpp"

namespace nutik {

struct KnownTemporary {
  std::atomic<bool> is_there{false};
  bool is_free = false;  // guarded by `registering_temporaries`
  KnownTemporary* next = nullptr;
  std::array<char, 4096> path{};
};

namespace {

KnownTemporary* make_known(const std::string& path) {
  const std::scoped_lock lock(shared_state().registering_temporaries);
  KnownTemporary* const known = &reused_entry(shared_state().temporaries);
  if (path.size() < known->path.size()) {
    std::memcpy(known->path.data(), path.c_str(), path.size() + 1);
    known->is_there = true;
  }
  return known;
}

void make_unknown(KnownTemporary* known) {
  const std::scoped_lock lock(shared_state().registering_temporaries);
  known->is_there = false;
  known->is_free = true;
}

// What a system call said of a file, or which folder is missing.
std::string reason_text(const std::filesystem::path& path, int reason) {
  const std::filesystem::path folder = path.parent_path();
  if (reason == ENOENT && !folder.empty() && is_absent(folder)) return format("there is no folder {}", folder.string());
  return std::strerror(reason);
}

[[noreturn]] void refuse(const std::filesystem::path& path, int reason) {
  throw OutputError(format("{} cannot be created: {}", path.string(), reason_text(path, reason)));
}

// Closed at the end of its block.
struct Opened {
  ~Opened() {
    if (descriptor >= 0) close(descriptor);
  }
  const int descriptor;
};

// Whether somebody else has put a link into a folder in which all may put something, such as /tmp: Linux refuses to
// follow it, too (fs.protected_symlinks), unless it was told otherwise.
bool is_foreign_in_shared_folder(const struct stat& link, const std::filesystem::path& folder) {
  struct stat around {};
  if (stat(folder.empty() ? "." : folder.c_str(), &around) != 0) refuse(folder, errno);
  constexpr mode_t kShared = S_ISVTX | S_IWOTH;
  return (around.st_mode & kShared) == kShared && link.st_uid != geteuid() && link.st_uid != around.st_uid;
}

// What a link points to is written, not the link replaced; also where it points to nothing yet.
std::filesystem::path followed(std::filesystem::path path) {
  constexpr int kMaxLinks = 40;  // as many as the system follows
  for (int links = 0;; ++links) {
    const Link link = read_link(path);
    if (link.error == ENOENT) return path;
    if (link.error != 0) refuse(path, link.error);
    if (!link.target) return path;
    if (links == kMaxLinks) {
      throw OutputError(format("{} is a link that leads nowhere; choose another name", path.string()));
    }
    if (is_foreign_in_shared_folder(link.status, path.parent_path())) {
      throw OutputError(format(
          "{} is another user's link in a folder that all may write to; choose another name", path.string()));
    }
    path = path.parent_path() / *link.target;
  }
}

// As many bytes of a name as a file system takes.
std::size_t longest_name(const std::filesystem::path& folder) {
  constexpr long kUsual = 255;
  const long stated = pathconf(folder.empty() ? "." : folder.c_str(), _PC_NAME_MAX);
  return static_cast<std::size_t>(stated > 0 ? stated : kUsual);
}

// A name's first bytes, and no half of a character: some file systems take none.
std::string_view beginning(std::string_view name, std::size_t bytes) {
  if (bytes >= name.size()) return name;
  const auto goes_on = [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) == 0x80U; };
  while (bytes > 0 && goes_on(name[bytes])) --bytes;
  return name.substr(0, bytes);
}

// Beside `path`, and as no other file is called: 64 random bits. Where the name has no room for more, its end gives
// way.
std::filesystem::path temporary_beside(const std::filesystem::path& path) {
  std::uint64_t random = 0;
  if (getentropy(&random, sizeof random) != 0) refuse(path, errno);
  const std::string ending = format(".nutik-{:016x}.part", random);
  const std::string name = path.filename().string();
  const std::size_t room = longest_name(path.parent_path());
  const std::size_t taken = 1 + ending.size();
  return path.parent_path() / format(".{}{}", beginning(name, room > taken ? room - taken : 0), ending);
}

// What may stand under a name when an output gets it: nothing, or this file, unwritten.
std::optional<OutputFile::Expected> take_expected(const std::filesystem::path& path) {
  const std::scoped_lock lock(shared_state().expecting_outputs);
  auto& expected = shared_state().expected_outputs;
  if (expected.empty()) return std::nullopt;
  const auto found = expected.find(led_to(path).string());
  if (found == expected.end()) return std::nullopt;
  std::optional<OutputFile::Expected> taken(std::in_place, found->second);
  expected.erase(found);
  return taken;
}

// Not by its number, which some file systems give anew whenever they are asked.
bool is_untouched(const struct stat& before, const struct stat& now) {
  return before.st_size == now.st_size && before.st_mtim.tv_sec == now.st_mtim.tv_sec &&
         before.st_mtim.tv_nsec == now.st_mtim.tv_nsec;
}

}  // namespace

void remove_temporary_files() {
  for (const KnownTemporary* known = shared_state().temporaries.load(); known != nullptr;
       known = known->next) {
    if (known->is_there) unlink(known->path.data());
  }
}

std::filesystem::path led_to(std::filesystem::path name) {
  namespace fs = std::filesystem;
  constexpr int kMaxLinks = 40;  // as many as the system follows
  std::error_code unknown;
  for (int links = 0; links < kMaxLinks && fs::is_symlink(name, unknown); ++links) {
    name = name.parent_path() / fs::read_symlink(name, unknown);
  }
  const fs::path folder = fs::canonical(name.has_parent_path() ? name.parent_path() : ".", unknown);
  if (!unknown) return folder / name.filename();
  const fs::path whole = fs::absolute(name, unknown);
  if (unknown == std::errc::no_such_file_or_directory)
    throw OutputError("the current folder is no longer there; go to another one");
  if (unknown) throw OutputError(format("{}: {}", name.string(), unknown.message()));
  return whole.lexically_normal();
}

void expect_as_it_is(const std::filesystem::path& output) {
  struct stat there {};
  const bool is_there = stat(output.c_str(), &there) == 0;
  const std::scoped_lock lock(shared_state().expecting_outputs);
  shared_state().expected_outputs.insert_or_assign(led_to(output).string(),
                                                   is_there ? OutputFile::Expected(there) : std::nullopt);
}

void expect_anything() {
  const std::scoped_lock lock(shared_state().expecting_outputs);
  shared_state().expected_outputs.clear();
}

void check_folder_of(const std::filesystem::path& output) {
  const std::filesystem::path folder = followed(output).parent_path();
  if (access(folder.empty() ? "." : folder.c_str(), W_OK | X_OK) != 0) refuse(output, errno);
}

bool has_kept_output() { return shared_state().has_kept_output; }

OutputFile::OutputFile(std::filesystem::path path, Lasting lasting)
    : path_(std::move(path)), lasting_(lasting) {
  if (lasting_ == Lasting::no) {
    temporary_path_ = path_;
    descriptor_ = open(path_.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) fail("cannot be written");
    return;
  }
  struct stat replaced {};
  if (stat(path_.c_str(), &replaced) == 0) {
    if (!S_ISREG(replaced.st_mode)) {
      throw OutputError(format("{} exists and is no regular file; choose another name", path_.string()));
    }
    replaced_mode_ = replaced.st_mode;
  } else if (errno != ENOENT && errno != ELOOP) {
    fail("cannot be created");
  }
  path_ = followed(std::move(path_));
  expected_ = take_expected(path_);
  // Nobody sees more of it than of what it replaces.
  constexpr mode_t kOurs = 0600, kAsTheUserWants = 0666;
  const mode_t mode = replaced_mode_ ? kOurs : kAsTheUserWants;
  if (lasting_ == Lasting::yes) {
    const std::filesystem::path folder = path_.parent_path();
    descriptor_ = open_nameless(folder.empty() ? "." : folder, O_WRONLY, mode);
    temporary_path_ = path_of(descriptor_);
    if (descriptor_ >= 0 && access(temporary_path_.c_str(), W_OK) == 0) return;
    if (descriptor_ >= 0) close(descriptor_);  // no /proc here
  }
  temporary_path_ = temporary_beside(path_);
  // What stands under this name already is somebody else's.
  descriptor_ = open(temporary_path_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, mode);
  if (descriptor_ < 0) fail("cannot be created");
  known_ = make_known(temporary_path_.string());
}

OutputFile::~OutputFile() {
  if (descriptor_ < 0) return;
  if (known_ != nullptr) {
    unlink(temporary_path_.c_str());
    make_unknown(known_);
  }
  close(descriptor_);
}

void OutputFile::fail(const char* what) const {
  const int reason = errno;
  check_mapped_files(losses_before_);  // what cannot be read cannot be written either
  const std::string name = lasting_ == Lasting::no
                               ? format("a temporary file in {} (or where TMPDIR says)", temporary_folder().string())
                               : path_.string();
  throw OutputError(format("{} {}: {}", name, what, reason_text(path_, reason)));
}

void OutputFile::write(std::span<const std::byte> bytes) {
  check();
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      fail("cannot be written");
    }
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    size_ += static_cast<std::uint64_t>(written);
  }
}

void OutputFile::replace(std::uint64_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0) {
      if (errno == EINTR) continue;
      fail("cannot be written");
    }
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    offset += static_cast<std::uint64_t>(written);
  }
}

void OutputFile::write(std::string_view text) { write(std::as_bytes(std::span(text))); }

void OutputFile::commit() {
  if (lasting_ == Lasting::no) {
    check_mapped_files(losses_before_);
    close(std::exchange(descriptor_, -1));
    return;
  }
  // What it replaces keeps its mode, but for the bits by which a program runs as its owner: this is another content.
  constexpr mode_t kKept = 01777;
  struct stat there {};
  const bool is_there = stat(path_.c_str(), &there) == 0;
  if (is_there) replaced_mode_ = there.st_mode;
  if (replaced_mode_) fchmod(descriptor_, *replaced_mode_ & kKept);
  // Not every file system can; all that can fail to write say so here.
  if (fsync(descriptor_) != 0 && errno != EINVAL) fail("cannot be written");
  // All of it has been read and written by now. It is right, whatever becomes of what it was made of after this.
  check_mapped_files(losses_before_);
  if (expected_ && is_there && !(*expected_ && is_untouched(**expected_, there))) stay_beside();
  if (expected_ && !is_there) {
    take_free_name();
  } else {
    take_name_beside();
    if (rename(temporary_path_.c_str(), path_.c_str()) != 0) fail("cannot be written");
  }
  shared_state().has_kept_output = true;
  if (known_ != nullptr) make_unknown(known_);
  close(std::exchange(descriptor_, -1));
  keep_name();
}

// A link replaces nothing that has the name by now.
void OutputFile::take_free_name() {
  const bool has_name = known_ == nullptr
                            ? give_name(descriptor_, path_)
                            : linkat(AT_FDCWD, temporary_path_.c_str(), AT_FDCWD, path_.c_str(), 0) == 0;
  if (has_name) {
    if (known_ != nullptr) unlink(temporary_path_.c_str());
    return;
  }
  if (errno == EEXIST) stay_beside();
  // Not every file system has links.
  if (known_ == nullptr || rename(temporary_path_.c_str(), path_.c_str()) != 0) fail("cannot be written");
}

// No call lets a file without a name replace another: it gets one beside it first.
void OutputFile::take_name_beside() {
  if (known_ != nullptr) return;
  temporary_path_ = temporary_beside(path_);
  known_ = make_known(temporary_path_.string());
  if (!give_name(descriptor_, temporary_path_)) fail("cannot be written");
}

void OutputFile::stay_beside() {
  take_name_beside();
  make_unknown(std::exchange(known_, nullptr));
  throw OutputError(format("{} was written by another program meanwhile, and is not replaced; what was made is {}, to "
                           "be renamed",
                           path_.string(), temporary_path_.string()));
}

// The name is the folder's, and reaches the disk with it. A folder that may be written to but not read cannot be asked.
void OutputFile::keep_name() const {
  const std::filesystem::path parent = path_.parent_path();
  const Opened folder{open(parent.empty() ? "." : parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
  if (folder.descriptor >= 0 && fsync(folder.descriptor) != 0 && errno != EINVAL) {
    throw OutputError(format("{} is whole, but whether its name has reached the disk is not known: {}",
                             path_.string(), std::strerror(errno)));
  }
}

void OutputFile::send_to_standard_output() {
  check_mapped_files(losses_before_);
  const MappedFile written(temporary_path_);
  for (auto rest = written.bytes(); !rest.empty();) {
    const ssize_t sent = ::write(STDOUT_FILENO, rest.data(), rest.size());
    if (sent >= 0) {
      rest = rest.subspan(static_cast<std::size_t>(sent));
    } else if (errno == EAGAIN) {
      pollfd until_it_takes_more{STDOUT_FILENO, POLLOUT, 0};
      poll(&until_it_takes_more, 1, -1);
    } else if (errno != EINTR) {
      throw OutputError(format("standard output cannot be written: {}", std::strerror(errno)));
    }
  }
}

void write_text(const std::filesystem::path& path, std::string_view text) {
  OutputFile file(path);
  file.write(text);
  file.commit();
}

void write_new_text(const std::filesystem::path& folder, const std::string& name, std::string_view text) {
  if (mkdir(folder.c_str(), S_IRWXU | S_IRWXG | S_IRWXO) != 0 && errno != EEXIST) refuse(folder, errno);
  const Opened ours{open_folder(folder)};
  struct stat status {};
  if (ours.descriptor < 0 || fstat(ours.descriptor, &status) != 0 || status.st_uid != geteuid()) {
    throw OutputError(format("{} is a link, or no folder of yours; nothing is written there. Move it away",
                             folder.string()));
  }
  const std::filesystem::path path = folder / printable(name);
  // In that very folder, whatever is put in its place meanwhile.
  const std::filesystem::path inside = path_in(ours.descriptor, folder, name);
  std::error_code unknown;
  if (std::filesystem::exists(std::filesystem::symlink_status(inside, unknown))) {
    throw OutputError(
        format("{} exists and is another file; it is not replaced. Move it away", path.string()));
  }
  try {
    write_text(inside, text);
  } catch (const OutputError& error) {
    throw OutputError(format("{} is not written: {}", path.string(), error.what()));
  }
}

}  // namespace nutik
