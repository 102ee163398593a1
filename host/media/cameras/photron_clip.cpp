// Recordings of Photron's cameras: a .mraw, and the header beside it (photron_header.hpp).
//
// Codes are as stored: values of 8 and 16 bits, the latter with their low byte first, and packed ones of 9 to 15 bits,
// the highest bit first; where a header says that only some bits of a value count, those. Colour is red, green, blue.
// What has no header, or one that lacks what is needed or tells of other pictures than the file has, is refused.
#include <cstring>
#include <string>
#include <string_view>
#include <system_error>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "media/cameras/photron_header.hpp"
#include "media/clip.hpp"
#include "media/formats/input_kinds.hpp"
#include "media/settled_fact.hpp"
#include "system/is_absent.hpp"
#include "system/mapped_file.hpp"

namespace nutik {
namespace {

namespace fs = std::filesystem;

// How the values of a picture lie in the file.
struct Layout {
  Shape shape;
  std::uint32_t bits = 0;   // of a value in the file
  std::uint32_t depth = 0;  // of those that count
  std::uint32_t shift = 0;  // bits below these

  [[nodiscard]] bool is_packed() const { return bits != 8 && bits != 16; }
  [[nodiscard]] std::uint64_t picture_bytes() const { return shape.value_count() * bits / 8; }
  [[nodiscard]] std::uint32_t code_bytes() const { return depth > 8 ? 2 : 1; }
};

[[noreturn]] void refuse(const fs::path& header, const std::string& why) {
  throw InputError(
      format("{}: {}; save the recording as TIFF or PNG, or describe its pictures", header.string(), why),
      {Setting::raw_layout});
}

std::uint32_t channels_of(const PhotronHeader& header) {
  const std::string& colour = header.pictures.colour;
  if (colour.starts_with("color") || colour == "rgb") return 3;
  // What the sensor saw: a colour camera's values are those of a mosaic.
  if (header.device.find("-c-") != std::string::npos || colour.find("bayer") != std::string::npos) {
    refuse(header.file, "its pictures are the mosaic of a colour sensor, which is not developed here");
  }
  if (colour == "mono" || colour == "raw") return 1;
  refuse(header.file, colour.empty() ? "it does not say whether its pictures are grey or colour"
                                     : format("pictures of the type '{}' are not read", colour));
}

Layout layout_of(const PhotronHeader& header) {
  const PhotronPictures& pictures = header.pictures;
  const fs::path& file = header.file;
  if (!pictures.file_format.empty() && pictures.file_format != "mraw") {
    refuse(file,
           format("it describes pictures in files of the kind '{}', not in a .mraw", pictures.file_format));
  }
  constexpr std::uint64_t kLargestSide = 1u << 16;
  if (pictures.width == 0 || pictures.height == 0 || pictures.width > kLargestSide ||
      pictures.height > kLargestSide) {
    refuse(file, "it does not say how large its pictures are, or not as a camera would");
  }
  Layout layout;
  layout.shape = {static_cast<std::uint32_t>(pictures.width), static_cast<std::uint32_t>(pictures.height),
                  channels_of(header)};
  layout.bits = static_cast<std::uint32_t>(pictures.pixel_bits / layout.shape.channels);
  if (layout.bits * layout.shape.channels != pictures.pixel_bits || layout.bits < 8 || layout.bits > 16) {
    refuse(file, format("its pixels have {} bits in {} channel{}; values of 8 to 16 bits are read",
                        pictures.pixel_bits, layout.shape.channels, layout.shape.channels == 1 ? "" : "s"));
  }
  layout.depth = static_cast<std::uint32_t>(pictures.depth == 0 ? layout.bits : pictures.depth);
  const bool is_upper = pictures.side == "higher";
  if (layout.depth > layout.bits || (layout.is_packed() && layout.depth != layout.bits) ||
      (layout.is_packed() && is_upper) || (!is_upper && pictures.side != "lower" && !pictures.side.empty())) {
    refuse(file, format("{} bits at the side '{}' of values of {} bits are not read", layout.depth,
                        pictures.side, layout.bits));
  }
  if (layout.shape.value_count() * layout.bits % 8 != 0) {
    refuse(file, format("of {} x {} pixels of {} bits a picture is no whole number of bytes",
                        layout.shape.width, layout.shape.height, pictures.pixel_bits));
  }
  if (is_upper) layout.shift = layout.bits - layout.depth;
  return layout;
}

// The header that tells of a recording. Throws where none does, or two may.
PhotronHeader header_of(const fs::path& path) {
  if (is_photron_header(path)) return read_photron_header(path);
  const std::vector<fs::path> headers = headers_beside(path);
  if (headers.size() == 1) return read_photron_header(headers.front());
  const std::string name = path.stem().string();
  if (!headers.empty()) {
    throw InputError(
        format("{}: two headers lie beside it, {}.cih and {}.cihx; name the one that is right in its place",
               path.string(), name, name));
  }
  throw InputError(
      format("{}: the camera's header is missing, which says how large the pictures are: {}.cih or {}.cihx beside it; "
             "without it the pictures have to be described",
             path.string(), name, name),
      {Setting::raw_layout});
}

fs::path pictures_of(const fs::path& path) {
  if (!is_photron_header(path)) return path;
  for (const char* extension : {".mraw", ".MRAW"}) {
    fs::path pictures = path;
    pictures.replace_extension(extension);
    if (!is_absent(pictures)) return pictures;
  }
  fs::path wanted = path.filename();
  wanted.replace_extension(".mraw");
  throw InputError(format("{} is a camera's header, and its pictures, {}, do not lie beside it",
                          path.string(), wanted.string()));
}

// Values packed one behind the other, the highest bit first.
void unpack(std::span<const std::byte> packed, std::uint32_t bits, std::span<std::uint16_t> codes) {
  const std::uint32_t mask = (1u << bits) - 1;
  std::uint32_t held = 0, held_bits = 0;
  std::size_t next = 0;
  for (std::uint16_t& code : codes) {
    while (held_bits < bits) {
      held = held << 8 | std::to_integer<std::uint32_t>(packed[next++]);
      held_bits += 8;
    }
    held_bits -= bits;
    code = static_cast<std::uint16_t>(held >> held_bits & mask);
  }
}

class PhotronClip final : public Clip {
 public:
  PhotronClip(const fs::path& path, const ClipOptions& options)
      : header_(header_of(path)),
        name_(pictures_of(path)),
        layout_(layout_of(header_)),
        file_(name_),
        count_(header_.pictures.count) {
    check_size(options.ends_at_damage);
    info_.format.shape = layout_.shape;
    info_.format.code_bytes = layout_.code_bytes();
    const std::uint32_t white = (1u << layout_.depth) - 1;
    info_.format.white_code = options.white_code.value_or(white);
    if (layout_.code_bytes() > 1) {
      settle_white(info_, options.white_code, white);
      if (!options.white_code) info_.facts.back().source = header_.file.filename().string();
    }
    // A sensor's values, of whatever depth.
    describe_stored_codes(info_, options, {Transfer::linear()});
    info_.timing.rate = header_.rate;
    info_.timing.exposed_ns = header_.exposed_ns;
    info_.timing.exposed_from = info_.timing.rate_from = header_.file.filename().string();
    info_.sample_count = count_;
    add_notes();
  }

  [[nodiscard]] const ClipInfo& info() const override { return info_; }

  bool read(std::span<std::byte> raster) override {
    if (!has_next()) return false;
    const auto picture = file_.bytes().subspan(next_ * layout_.picture_bytes(), layout_.picture_bytes());
    if (layout_.is_packed()) {
      unpack(picture, layout_.bits,
             {reinterpret_cast<std::uint16_t*>(raster.data()), layout_.shape.value_count()});
    } else if (layout_.shift == 0 && layout_.bits == 8 * layout_.code_bytes()) {
      std::memcpy(raster.data(), picture.data(), picture.size());
    } else {
      move_down(picture, raster);
    }
    file_.release(picture);
    ++next_;
    return true;
  }

  bool skip(std::span<std::byte> /*room*/) override {
    if (!has_next()) return false;
    ++next_;
    return true;
  }

 private:
  // Throws where the file ends before the next picture does.
  [[nodiscard]] bool has_next() const {
    if (next_ == count_) return false;
    if ((next_ + 1) * layout_.picture_bytes() > file_.bytes().size()) throw cut_off();
    return true;
  }

  [[nodiscard]] std::string described() const {
    return format("{} x {} pixels of {} bits", layout_.shape.width, layout_.shape.height,
                  layout_.bits * layout_.shape.channels);
  }

  [[nodiscard]] InputError cut_off() const {
    return InputError(
        format("{} was cut off: {} names {} pictures ({}), and it has {} whole ones, which can be taken",
               name_.string(), header_.file.filename().string(), count_, described(),
               file_.bytes().size() / layout_.picture_bytes()),
        {Setting::end_at_damage});
  }

  void check_size(bool ends_at_damage) {
    const std::uint64_t bytes = file_.bytes().size(), one = layout_.picture_bytes();
    if (count_ == 0 && bytes % one == 0) count_ = bytes / one;
    if (count_ * one == bytes && count_ > 0) return;
    if (bytes < count_ * one && count_ > 0) {
      if (ends_at_damage && bytes >= one) return;
      throw cut_off();
    }
    throw InputError(
        format("{} has {} bytes, and {} names {} pictures, {} bytes each ({}): it is of another recording",
               name_.string(), bytes, header_.file.filename().string(), count_, one, described()));
  }

  void add_notes() {
    if (header_.step > 1) {
      info_.notes.emplace_back(format("{} says that one of {} pictures was saved: the rate is that of these",
                                      header_.file.filename().string(), header_.step),
                               std::vector{Setting::frame_rate});
    }
    if (header_.pictures.is_processed) {
      info_.notes.emplace_back(
          "the camera's program processed the values when it saved them: light may not be proportional to "
          "them",
          std::vector{Setting::transfer});
    }
  }

  // 16-bit values, their low byte first.
  [[nodiscard]] static std::uint32_t word(std::span<const std::byte> bytes, std::size_t index) {
    return std::to_integer<std::uint32_t>(bytes[2 * index]) |
           std::to_integer<std::uint32_t>(bytes[2 * index + 1]) << 8;
  }

  void move_down(std::span<const std::byte> picture, std::span<std::byte> raster) const {
    for (std::size_t i = 0; i < layout_.shape.value_count(); ++i) {
      const std::uint32_t value =
          layout_.bits == 8 ? std::to_integer<std::uint32_t>(picture[i]) : word(picture, i);
      if (value % (1u << layout_.shift) != 0) {
        throw InputError(format(
            "{}: picture {} has the value {}, and {} says that only the {} upper of {} bits "
            "count",
            name_.string(), next_, value, header_.file.filename().string(), layout_.depth, layout_.bits));
      }
      store(value >> layout_.shift, i, raster);
    }
  }

  void store(std::uint32_t code, std::size_t index, std::span<std::byte> raster) const {
    if (layout_.depth > 8) {
      const auto stored = static_cast<std::uint16_t>(code);
      std::memcpy(raster.data() + 2 * index, &stored, sizeof stored);
      return;
    }
    if (code > 255) {
      throw InputError(format("{}: picture {} has the value {}, and {} says that {} bits count",
                              name_.string(), next_, code, header_.file.filename().string(), layout_.depth));
    }
    raster[index] = static_cast<std::byte>(code);
  }

  PhotronHeader header_;
  fs::path name_;
  Layout layout_;
  MappedFile file_;
  std::uint64_t count_;
  std::uint64_t next_ = 0;
  ClipInfo info_;
};

// The pictures, then the header, which is the one that was named, else what lies beside.
std::optional<inputs::Files> files_of(const fs::path& path) {
  if (!inputs::kPhotron.is_named(path) || is_absent(path)) return std::nullopt;
  inputs::Files files{pictures_of(path)};
  if (is_photron_header(path)) files.push_back(path);
  std::error_code error;
  for (const fs::path& header : headers_beside(path)) {
    if (files.size() == 1 && fs::is_regular_file(header, error)) files.push_back(header);
  }
  return files;
}

}  // namespace

constinit const inputs::InputKind inputs::kPhotron{
    .name = "Photron", .extensions = " .mraw .cih .cihx ",
    .said = {"the header", "the header", "as stored, linear, white by the header's bits", "none", "none", "as stored"},
    .has_front = false, .files = files_of,
    .open = [](const fs::path& path, const Files&, const ClipOptions& options) -> std::unique_ptr<Clip> {
      return std::make_unique<PhotronClip>(path, options);
    }};

}  // namespace nutik
