#include "media/stills/netpbm.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <string_view>

#include "capture/capture_mark.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/text.hpp"
#include "media/clip.hpp"
#include "media/formats/input_kinds.hpp"
#include "media/stills/picture_text.hpp"
#include "system/interruption.hpp"
#include "system/output_file.hpp"

namespace nutik {
namespace {

constexpr std::uint64_t kLargestNetpbmSide = 1u << 20;

class NetpbmReader {
 public:
  NetpbmReader(std::span<const std::byte> file, const std::string& name)
      : text_(as_text(file)), name_(name) {}

  // Passes over a picture: how many bytes it has.
  std::size_t pass() {
    const auto [shape, maximum, raw] = read_front();
    const std::uint64_t value_size = maximum > 255 ? 2 : 1;
    if (raw) return at_ + stored_count(shape) * value_size;
    for (std::uint64_t i = 0; i < shape.value_count(); ++i) number("value", 65'535);
    return at_;
  }

  Picture read() {
    const auto [shape, maximum, raw] = read_front();
    const std::uint64_t value_size = maximum > 255 ? 2 : 1;
    Picture picture(shape, maximum > 255 ? ValueType::code16 : ValueType::code8, maximum);
    for (std::uint64_t i = 0; i < shape.value_count(); ++i) {
      if (i % 65'536 == 0) check_interruption();
      const std::uint32_t code = raw ? raw_value(value_size) : number("value", 65'535);
      if (has_alpha_ && (i + 1) % shape.channels == 0) at_ += value_size;
      if (code > maximum) fail(format("value {} is above its maximum of {}", code, maximum));
      if (maximum > 255) {
        picture.values<std::uint16_t>()[i] = static_cast<std::uint16_t>(code);
      } else {
        picture.values<std::uint8_t>()[i] = static_cast<std::uint8_t>(code);
      }
    }
    return picture;
  }

  // Whether the picture that was read has transparency, which is left out.
  [[nodiscard]] bool has_alpha() const { return has_alpha_; }

  // PF or Pf, width, height, a number whose sign is that of machines with their low bytes first if it is below 0; then
  // rows from the bottom up.
  Picture read_light() {
    if (!text_.starts_with("PF") && !text_.starts_with("Pf")) fail("it is no PFM picture");
    at_ = 2;
    Shape shape;
    shape.width = number("width", kLargestNetpbmSide);
    shape.height = number("height", kLargestNetpbmSide);
    shape.channels = text_[1] == 'F' ? 3 : 1;
    skip_space();
    double scale = 0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), scale);
    if (error != std::errc() || scale == 0) fail("it does not say in which order its bytes are");
    at_ = static_cast<std::size_t>(end - text_.data()) + 1;
    if (shape.width == 0 || shape.height == 0) fail("its size is 0");
    const std::uint64_t needed = shape.value_count() * sizeof(float);
    if (at_ > text_.size() || text_.size() - at_ < needed) {
      fail(format("it was cut off: {} x {} pixels need {} bytes, {} are left", shape.width, shape.height, needed,
                  text_.size() - std::min(at_, text_.size())));
    }
    if (const std::uint64_t more = text_.size() - at_ - needed; more > 0)
      fail(format("it goes on behind its picture, by {} bytes; write each picture to a file of its own", more));
    Picture picture(shape, ValueType::light32, 0);
    const std::size_t row_bytes = std::size_t{shape.width} * shape.channels * sizeof(float);
    for (std::uint32_t y = shape.height; y-- > 0; at_ += row_bytes)
      std::memcpy(picture.bytes.data() + y * row_bytes, text_.data() + at_, row_bytes);
    if ((scale < 0) != (std::endian::native == std::endian::little)) {
      for (std::size_t i = 0; i < picture.bytes.size(); i += sizeof(float))
        std::reverse(picture.bytes.data() + i, picture.bytes.data() + i + sizeof(float));
    }
    return picture;
  }

 private:
  struct Front {
    Shape shape;
    std::uint32_t maximum;
    bool is_raw;
  };

  // All before the values, which follow if they are raw.
  Front read_front() {
    if (text_.size() < 3 || text_[0] != 'P') fail("it is no Netpbm picture");
    if (begins_as_capture(text_)) {
      fail("it is a capture (.tik), whose front shows its first sample alone; expose a picture from it");
    }
    const char kind = text_[1];
    if (kind != '2' && kind != '3' && kind != '5' && kind != '6' && kind != '7') {
      fail(format("it is a P{}; PGM (P2, P5), PPM (P3, P6) and PAM (P7) are read", kind));
    }
    at_ = 2;
    Shape shape;
    std::uint32_t maximum = 0;
    if (kind == '7') {
      read_pam_lines(shape, maximum);
    } else {
      shape.width = number("width", kLargestNetpbmSide);
      shape.height = number("height", kLargestNetpbmSide);
      shape.channels = kind == '3' || kind == '6' ? 3 : 1;
      maximum = number("maximum", 65'535);
    }
    if (shape.width == 0 || shape.height == 0 || maximum == 0) fail("its size or maximum is 0");
    const bool raw = kind == '5' || kind == '6' || kind == '7';
    const std::uint64_t value_size = maximum > 255 ? 2 : 1;
    // Before anything is allocated: a raw picture's bytes are all there, a plain one has two a value.
    const std::uint64_t needed = stored_count(shape) * (raw ? value_size : 2);
    if (raw) ++at_;  // the one white-space character before the raster
    if (at_ > text_.size() || text_.size() - at_ + 1 < needed) {
      fail(format("it was cut off: {} x {} pixels need {} bytes, {} are left", shape.width, shape.height,
                  needed, text_.size() - std::min(at_, text_.size())));
    }
    return {shape, maximum, raw};
  }

  [[nodiscard]] std::uint64_t stored_count(const Shape& shape) const {
    return shape.value_count() + (has_alpha_ ? shape.pixel_count() : 0);
  }

  // Lines in any order up to ENDHDR. TUPLTYPE says no more than DEPTH does, except of transparency: four may be CMYK.
  void read_pam_lines(Shape& shape, std::uint32_t& maximum) {
    shape.channels = 0;
    for (std::string_view word; word != "ENDHDR";) {
      skip_space();
      word = text_.substr(at_, text_.find_first_of(" \t\r\n", at_) - at_);
      if (word.empty()) fail("it was cut off: its front has no end");
      at_ += word.size();
      if (word == "WIDTH") {
        shape.width = number("width", kLargestNetpbmSide);
      } else if (word == "HEIGHT") {
        shape.height = number("height", kLargestNetpbmSide);
      } else if (word == "DEPTH") {
        shape.channels = number("depth", 65'535);
      } else if (word == "MAXVAL") {
        maximum = number("maximum", 65'535);
      } else if (word != "ENDHDR") {
        const std::string_view line = text_.substr(at_, text_.find_first_of("\r\n", at_) - at_);
        if (word == "TUPLTYPE") has_alpha_ = line.ends_with("_ALPHA");
        at_ = std::min(text_.find('\n', at_), text_.size());
      }
    }
    has_alpha_ &= shape.channels == 2 || shape.channels == 4;
    if (has_alpha_) --shape.channels;
    if (shape.channels == 1 || shape.channels == 3) return;
    fail(format("it has {} channels; grey (1) and colour (3) are read, and beside them transparency (TUPLTYPE "
                "GRAYSCALE_ALPHA or RGB_ALPHA): save it as one of these",
                shape.channels));
  }

  [[noreturn]] void fail(const std::string& why) const {
    throw InputError(format("{} cannot be read: {}", name_, why));
  }

  void skip_space() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '#') {
        while (at_ < text_.size() && text_[at_] != '\n') ++at_;
      } else if (c != ' ' && c != '\t' && c != '\n' && c != '\r' && c != '\v' && c != '\f') {
        return;
      } else {
        ++at_;
      }
    }
  }

  std::uint32_t number(const char* what, std::uint64_t limit) {
    skip_space();
    std::uint64_t value = 0;
    const std::size_t start = at_;
    while (at_ < text_.size() && text_[at_] >= '0' && text_[at_] <= '9') {
      value = value * 10 + static_cast<std::uint64_t>(text_[at_++] - '0');
      if (value > limit) fail(format("its {} is above {}", what, limit));
    }
    if (at_ == start) {
      fail(at_ == text_.size() ? format("it was cut off: a {} is missing", what)
                               : format("a {} is missing at byte {}", what, at_));
    }
    return static_cast<std::uint32_t>(value);
  }

  std::uint32_t raw_value(std::uint64_t bytes) {
    if (at_ + bytes > text_.size()) fail("it was cut off");
    std::uint32_t value = 0;
    for (std::uint64_t i = 0; i < bytes; ++i) {
      value = value << 8 | static_cast<unsigned char>(text_[at_++]);
    }
    return value;
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
  bool has_alpha_ = false;
};

}  // namespace

Picture read_netpbm(std::span<const std::byte> file, const std::string& name) {
  NetpbmReader reader(file, name);
  Picture picture = reader.read();
  if (reader.has_alpha()) refuse_left_out(name, kTransparency);
  return picture;
}

std::vector<std::size_t> netpbm_starts(std::span<const std::byte> file, const std::string& name) {
  std::vector<std::size_t> starts{0};
  try {
    for (std::size_t at = 0;;) {
      at += NetpbmReader(file.subspan(at), name).pass();
      while (at < file.size() && file[at] == std::byte{'\n'}) ++at;
      if (at >= file.size()) return starts;  // the last one may be cut short
      if (!begins_as_netpbm(as_text(file.subspan(at)))) return starts;
      starts.push_back(at);
    }
  } catch (const InputError&) {  // it is said when that picture is read
    return starts;
  }
}

std::string netpbm_text(const Picture& picture, const std::string& comment) {
  const Shape& shape = picture.shape;
  const bool colour = shape.channels == 3;
  if (picture.type == ValueType::light32) {
    std::string text = format("{}\n{} {}\n-1.0\n", colour ? "PF" : "Pf", shape.width, shape.height);
    const std::size_t row_bytes = std::size_t{shape.width} * shape.channels * sizeof(float);
    for (std::uint32_t y = shape.height; y-- > 0;)
      text += as_text(picture.bytes).substr(y * row_bytes, row_bytes);
    return text;
  }
  std::string text =
      format("{}\n{}{}{} {}\n{}\n", colour ? "P6" : "P5", comment.empty() ? "" : "# " + comment,
             comment.empty() ? "" : "\n", shape.width, shape.height, picture.white_code);
  if (picture.type == ValueType::code8) {
    text += as_text(picture.bytes);
  } else {
    for (const std::uint16_t code : picture.values<std::uint16_t>()) {
      if (picture.white_code > 255) text.push_back(static_cast<char>(code >> 8));
      text.push_back(static_cast<char>(code & 0xFF));
    }
  }
  return text;
}

namespace {

FilePicture read_codes(std::span<const std::byte> file, const std::string& name, std::size_t begin) {
  NetpbmReader reader(file.subspan(std::min(begin, file.size())), name);
  Picture picture = reader.read();
  const std::uint32_t maximum = picture.white_code;
  return {.picture = std::move(picture), .maximum = maximum, .left_out = reader.has_alpha() ? kTransparency : ""};
}

// Light as it stands, whatever its scale.
FilePicture read_pfm(std::span<const std::byte> file, const std::string& name, std::size_t) {
  return {NetpbmReader(file, name).read_light()};
}

// The comments behind the first line.
std::optional<std::string> netpbm_comment(std::span<const std::byte> bytes, const std::filesystem::path&) {
  const std::string_view file = as_text(bytes);
  auto at = file.find('\n');
  while (at != std::string_view::npos && at + 1 < file.size() && file[at + 1] == '#') {
    const auto end = file.find('\n', at + 1);
    if (end == std::string_view::npos) break;
    std::string_view comment = file.substr(at + 2, end - at - 2);
    if (comment.starts_with(' ')) comment.remove_prefix(1);
    if (comment.starts_with(kPictureTextStart)) return std::string(comment);
    at = end;
  }
  return std::nullopt;
}

void write_netpbm(OutputFile& file, const Picture& picture, const std::string& text, const FileWishes&) {
  file.write(netpbm_text(picture, text));
}

}  // namespace

constinit const inputs::InputKind inputs::kNetpbm{
    .name = "Netpbm", .starts = {"P2", "P3", "P5", "P6", "P7"}, .extensions = " .pgm .ppm .pnm .pam ",
    .said = {"none", "none", "as stored, white is its maximum", "none", "left out",
             "one behind the other"},
    .behind_start = " \t\r\n", .read = read_codes, .places = netpbm_starts, .text = netpbm_comment,
    .written = {{.extension = ".ppm", .code_bits = 16, .is_silent = true, .only_channels = 3, .write = write_netpbm},
                {.extension = ".pgm", .code_bits = 16, .is_silent = true, .only_channels = 1, .write = write_netpbm},
                {.also = ".pnm", .code_bits = 16, .is_silent = true, .write = write_netpbm}}};

constinit const inputs::InputKind inputs::kPfm{
    .name = "PFM", .starts = {"PF", "Pf"}, .extensions = " .pfm ",
    .said = {"none", "none", "as of OpenEXR", "none", "none", "one picture"},
    .behind_start = " \t\r\n", .has_tags = true, .read = read_pfm,
    .written = {{.extension = ".pfm", .holds_light = true, .is_silent = true, .write = write_netpbm}}};

}  // namespace nutik
