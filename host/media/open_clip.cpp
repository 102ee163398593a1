#include <atomic>
#include <system_error>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/cameras/photron_header.hpp"
#include "media/cameras/sony_file.hpp"
#include "media/clip_part.hpp"
#include "media/formats/file_kinds.hpp"
#include "media/formats/input_kinds.hpp"
#include "media/module.hpp"
#include "media/stills/still_sequence.hpp"
#include "media/stills/stills_table.hpp"
#include "system/input_bytes.hpp"
#include "system/is_absent.hpp"

namespace nutik {
namespace {

using inputs::Files, inputs::InputKind;

std::unique_ptr<Clip> open_table(const std::filesystem::path& path, const Files& files, const ClipOptions& options) {
  const StillModule& module = still_module();
  const std::vector<ListedStill> stills = read_stills_table(path);
  std::vector<StillTimes> exif;
  ClipTiming listed;  // for whoever wants to know what a stated rate replaces
  for (const ListedStill& still : stills) {
    if (still.times.start_ns) listed.starts_ns.push_back(*still.times.start_ns);
    const bool is_timed = still.times.start_ns && still.times.exposure_ns;
    exif.push_back(is_timed || options.rate ? StillTimes{} : module.read_exif_times(still.file));
  }
  if (listed.starts_ns.size() < stills.size()) listed.starts_ns.clear();
  // The table itself is the first of its files.
  return module.open(std::span(files).subspan(1), options.rate ? listed : timing_of(path, stills, exif), options);
}

// A clip with a picture that cannot be read: that is its end, or an error which says that it could be.
class PerhapsDamaged final : public Clip {
 public:
  PerhapsDamaged(std::unique_ptr<Clip> clip, ClipInfo info, const std::filesystem::path& path, bool has_files,
                 bool ends_at_damage)
      : clip_(std::move(clip)),
        info_(std::move(info)),
        name_(input_title(path.string())),
        has_files_(has_files),
        ends_at_damage_(ends_at_damage) {}

  [[nodiscard]] const ClipInfo& info() const override { return info_; }

  bool read(std::span<std::byte> raster) override {
    return take([&] { return clip_->read(raster); });
  }
  bool skip(std::span<std::byte> room) override {
    return take([&] { return clip_->skip(room); });
  }

  [[nodiscard]] bool tells_changes() const override { return clip_->tells_changes(); }
  [[nodiscard]] bool makes_codes() const override { return clip_->makes_codes(); }
  std::optional<std::span<const PixelChange>> read_changes() override { return clip_->read_changes(); }

  [[nodiscard]] std::optional<std::string> ended_early() const override {
    return has_ended_ ? std::optional(reason_) : std::nullopt;
  }
  [[nodiscard]] std::vector<Note> remarks() const override { return clip_->remarks(); }

 private:
  template <typename Take>
  bool take(Take take_next) {
    if (has_ended_) return false;
    try {
      if (!take_next()) return false;
      ++samples_read_;
      return true;
    } catch (const InputError& error) {
      // What has settings of its own is no damage.
      if (samples_read_ == 0 || (!ends_at_damage_ && !error.settings().empty())) throw;
      if (!ends_at_damage_) {
        throw InputError(format("{}; {}the {} before it can be taken", error.what(),
                                has_files_ ? "a folder or table without it keeps the others, and " : "",
                                samples_read_ == 1 ? "picture" : format("{} pictures", samples_read_)),
                         {Setting::end_at_damage});
      }
      reason_ = format("{} is taken as far as it goes, {} of {} pictures: {}", name_, samples_read_,
                       info_.sample_count, error.what());
      has_ended_ = true;
      return false;
    }
  }

  std::unique_ptr<Clip> clip_;
  ClipInfo info_;
  std::string name_;
  bool has_files_;  // one for each picture
  bool ends_at_damage_;
  std::uint64_t samples_read_ = 0;
  std::string reason_;
  std::atomic<bool> has_ended_ = false;  // asked for while another thread reads; `reason_` stays from then on
};

// Pictures that tell no times themselves have those of the camera's header beside them.
void add_photron_header(ClipInfo& info, const std::filesystem::path& pictures, const Files&) {
  if (info.timing.is_known()) return;
  const auto header = photron_header_of(pictures);
  if (!header) return;
  info.timing.rate = header->rate;
  info.timing.exposed_ns = header->exposed_ns;
  info.timing.exposed_from = info.timing.rate_from = header->file.filename().string();
}

std::unique_ptr<Clip> open_stills(const std::filesystem::path&, const Files& stills, const ClipOptions& options) {
  return still_module().open(stills, {}, options);
}

void describe_stills(ClipInfo& info, const std::filesystem::path& path, const Files& stills) {
  std::error_code error;
  const bool is_folder = std::filesystem::is_directory(path, error);
  for (auto note : {is_folder ? missing_still_note(path, stills) : mixed_note(path, stills),
                    is_folder ? left_out_note(path, stills) : std::nullopt}) {
    if (note) info.notes.emplace_back(std::move(*note));
  }
  if (is_folder) add_photron_header(info, path, stills);
  if (!info.timing.is_known() && still_module().read_exif_times(stills.front()).start_ns)
    info.timing.rate_doubt = "it has EXIF times, which are read where a table (.csv) lists the files";
}

void refuse_absent(const std::filesystem::path& path) {
  if (is_absent(path)) throw FileMissing(path, format("{} cannot be read: no such file", path.string()));
  std::error_code error;
  if (std::filesystem::is_regular_file(path, error) && std::filesystem::is_empty(path, error))
    throw InputError(format("{} is empty; was it copied, or recorded, to its end?", input_title(path.string())));
}

void refuse_event_options(const std::filesystem::path& path, const EventOptions& events) {
  std::vector<Setting> stated;
  if (events.contrast) stated.push_back(Setting::contrast);
  if (events.start) stated.push_back(Setting::start_picture);
  if (events.tick_ns) stated.push_back(Setting::tick);
  if (stated.empty()) return;
  throw UsageError(format("{} holds pictures, of which nothing is said by events; leave that out",
                          input_title(path.string())),
                   std::move(stated));
}

std::optional<Files> files_of_table(const std::filesystem::path& path) {
  if (!is_stills_table(path)) return std::nullopt;
  Files files{path};  // the times of its stills
  for (const ListedStill& still : read_stills_table(path)) files.push_back(still.file);
  return files;
}

std::unique_ptr<Clip> open_video(const std::filesystem::path& path, const Files&, const ClipOptions& options) {
  refuse_absent(path);
  if (!options.raw) refuse_text(path);
  return video_module().open(path, options);
}

struct KindOf {
  const InputKind& kind;
  Files files;
};

KindOf kind_of(const std::filesystem::path& path, bool is_raw) {
  if (is_raw) return {inputs::kRawVideo, {path}};
  const std::filesystem::path& file = is_standard_input(path.string()) ? standard_input_file() : path;
  for (const InputKind* kind : inputs::kClips) {
    if (kind->files == nullptr && kind->begins(telling_bytes(file))) return {*kind, {path}};
    if (auto files = kind->files == nullptr ? std::nullopt : kind->files(path)) return {*kind, std::move(*files)};
  }
  return {inputs::kVideo, {path}};
}

}  // namespace

constinit const InputKind inputs::kVideo{
    .name = "video", .otherwise = "what FFmpeg takes it for",
    .said = {"its pictures' times; filming rates of Android, Samsung and Sony", "none",
             "colour: RGB of 8 bits, or over 16, by matrix and range; grey: as stored, white by its bits; or by range",
             "display matrix, by quarter turns", "left out", "as shown"},
    .open = open_video};
constinit const InputKind inputs::kRawVideo{
    .name = "raw video", .otherwise = "your description",
    .said = {"Photron's header beside it", "that header", "as of a video", "none", "left out",
             "as stored"},
    .open = open_video, .describe = add_photron_header};
constinit const InputKind inputs::kSequence{
    .name = "several stills", .otherwise = "a folder, `'frames/*.png'`, `frame%04d.tif`",
    .said = {"the first one's, else a folder's only Photron header", "as the times", "alike in all", "each one's",
             "as of one", "as a person counts, 2 before 10"},
    .files = list_stills, .open = open_stills, .describe = describe_stills};
constinit const InputKind inputs::kTable{
    .name = "table of stills", .extensions = " .csv ",
    .said = {"its column, else EXIF", "its column, else EXIF", "alike in all", "each one's", "as of one", "its rows"},
    .files = files_of_table, .open = open_table};

std::vector<std::filesystem::path> files_of_clip(const std::filesystem::path& path, bool is_raw) {
  auto [kind, files] = kind_of(path, is_raw);
  std::error_code error;
  const bool is_folder = kind == inputs::kSequence && std::filesystem::is_directory(path, error);
  if (is_raw || is_folder) {
    if (const auto header = photron_header_of(path)) files.push_back(header->file);
  } else if (kind == inputs::kVideo && !is_absent(sony_file_of(path))) {
    const std::filesystem::path story = video_module().story_beside(path);
    if (!story.empty()) files.push_back(story);
  }
  return files;
}

std::unique_ptr<Clip> open_clip(const std::filesystem::path& name, const ClipOptions& options) {
  const std::filesystem::path& path = is_standard_input(name.string()) ? standard_input_file() : name;
  if (!options.raw) refuse_unsupported_kind(path);
  const auto [kind, files] = kind_of(path, options.raw.has_value());
  if (!kind.has_events) refuse_event_options(path, options.events);
  std::unique_ptr<Clip> clip = kind.open(path, files, options);
  ClipInfo info = clip->info();
  if (kind.describe != nullptr) kind.describe(info, path, files);
  const bool has_files = files.size() > 1;
  return take_part(
      std::make_unique<PerhapsDamaged>(std::move(clip), std::move(info), path, has_files, options.ends_at_damage), path,
      options);
}

}  // namespace nutik
