// NumPy's arrays in files (.npy), as pictures: [height, width], which may have a last axis of 1 or 3, or several behind
// one another, with an axis in front. https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html has the
// bytes.

#include <algorithm>
#include <bit>
#include <numeric>
#include <string_view>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/text.hpp"
#include "media/formats/input_kinds.hpp"
#include "system/output_file.hpp"

namespace nutik {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr std::size_t kLengthAt = 8, kAlignment = 64;
constexpr std::uint64_t kLargestNpySide = 1u << 20;
// How NumPy writes this machine's order of bytes.
constexpr char kOrder = std::endian::native == std::endian::little ? '<' : '>';

[[noreturn]] void fail(const std::string& name, const std::string& why) {
  throw InputError(format("{} cannot be read: {}", name, why));
}

// What stands behind a key, without blanks, up to the end of the front.
std::string_view behind_key(std::string_view front, std::string_view key, const std::string& name) {
  const std::size_t at = front.find(key);
  if (at == front.npos) fail(name, format("its front does not say its {}", key));
  front.remove_prefix(at + key.size());
  const std::size_t value = front.find_first_not_of("': ");
  return front.substr(value == front.npos ? front.size() : value);
}

ValueType type_of(std::string_view word, const std::string& name) {
  if (word.starts_with("|u1")) return ValueType::code8;
  if (word.starts_with(kOrder)) {
    const std::string_view kind = word.substr(1, 2);
    if (kind == "u2") return ValueType::code16;
    if (kind == "f4") return ValueType::light32;
    if (kind == "f8") return ValueType::light64;
  }
  const bool is_whole = word.size() > 1 && (word[1] == 'u' || word[1] == 'i');
  fail(name, format("its values are '{}'; uint8, uint16, float32 and float64 in this machine's order are read: "
                    "numpy.save(file, array{}'))",
                    word.substr(0, word.find('\'')),
                    is_whole ? ".clip(0, 65535).astype('uint16" : ".astype('float32"));
}

// `(2, 3), …`
std::vector<std::uint64_t> axes_of(std::string_view text) {
  std::vector<std::uint64_t> axes;
  if (!text.starts_with('(')) return axes;
  for (text.remove_prefix(1); !text.empty() && text.front() != ')';) {
    std::uint64_t length = 0;
    if (!take_number(text, length)) return {};
    axes.push_back(length);
    text.remove_prefix(std::min(text.find_first_not_of(", "), text.size()));
  }
  return axes;
}

// Up to the values; `axes` stand before those of a picture.
std::string front_text(const Picture& picture, const std::string& axes) {
  const Shape& shape = picture.shape;
  std::string front =
      format("{{'descr': '{}f{}', 'fortran_order': False, 'shape': ({}{}, {}{}), }}", kOrder, value_bytes(picture.type),
             axes, shape.height, shape.width, shape.channels == 3 ? ", 3" : "");
  const std::size_t length_end = kLengthAt + 2;
  const std::size_t begin = (length_end + front.size()) / kAlignment * kAlignment + kAlignment;
  front.resize(begin - length_end - 1, ' ');
  front += '\n';
  std::string text(kMagic);
  for (const std::size_t byte : {std::size_t{1}, std::size_t{0}, front.size() % 256, front.size() / 256})
    text.push_back(static_cast<char>(byte));
  return text + front;
}

// What an array holds: pictures of a shape and type, and where the first one's bytes begin.
struct NpyFront {
  Shape shape;
  ValueType type = ValueType::light32;
  std::uint64_t pictures = 1;
  std::size_t begin = 0;
};

// Arrays of uint8 and uint16 are codes, of float32 and float64 light. Throws InputError naming `name` where it is of
// another type or order, has other axes, was cut off, or goes on behind it.
NpyFront read_npy_front(std::span<const std::byte> file, const std::string& name) {
  const std::string_view text = as_text(file);
  if (!text.starts_with(kMagic) || text.size() < kLengthAt + 4) fail(name, "it is no array of NumPy's, or was cut off");
  // The length of the front has two bytes in version 1, and four since; the low one first.
  const std::size_t length_bytes = text[kMagic.size()] == 1 ? 2 : 4;
  std::size_t length = 0;
  for (std::size_t i = length_bytes; i-- > 0;)
    length = length << 8 | static_cast<unsigned char>(text[kLengthAt + i]);
  NpyFront front;
  front.begin = kLengthAt + length_bytes + length;
  if (front.begin > text.size()) fail(name, "it was cut off");
  const std::string_view words = text.substr(kLengthAt + length_bytes, length);
  front.type = type_of(behind_key(words, "descr", name), name);
  if (!behind_key(words, "fortran_order", name).starts_with("False"))
    fail(name, "its columns lie behind one another; write numpy.ascontiguousarray(array)");
  std::vector<std::uint64_t> axes = axes_of(behind_key(words, "shape", name));
  const std::uint64_t last = axes.size() > 2 ? axes.back() : 0;
  if (last == 2 || last == 4) {
    fail(name, format("its last axis is {}: grey and RGB are read, numpy.save(file, array[..., {}])", last,
                      last == 4 ? ":3" : "0"));
  }
  if (last == 1) axes.pop_back();
  front.shape.channels = last == 3 ? 3 : 1;
  const std::size_t own = last == 3 ? 3 : 2;
  if (axes.size() < own || axes.size() > own + 1)
    fail(name, "its axes are none of [height, width], [height, width, 3] or several of these");
  if (axes.size() > own) front.pictures = axes.front();
  axes.erase(axes.begin(), axes.end() - static_cast<std::ptrdiff_t>(own));
  if (axes[0] == 0 || axes[1] == 0 || axes[0] > kLargestNpySide || axes[1] > kLargestNpySide || front.pictures == 0)
    fail(name, format("it states {} pictures of {} x {} pixels", front.pictures, axes[1], axes[0]));
  front.shape.height = static_cast<std::uint32_t>(axes[0]);
  front.shape.width = static_cast<std::uint32_t>(axes[1]);
  const std::uint64_t picture = front.shape.value_count() * value_bytes(front.type), left = text.size() - front.begin;
  if (left / picture < front.pictures) {
    fail(name, format("it was cut off: it states {} pictures of {} x {} pixels, and {} bytes are left", front.pictures,
                      front.shape.width, front.shape.height, left));
  }
  if (left > front.pictures * picture) {
    fail(name, format("it goes on behind its array, by {} bytes; write several as one: numpy.stack(arrays)",
                      left - front.pictures * picture));
  }
  return front;
}

// From 0 on.
std::vector<std::size_t> numbers_of_pictures(std::span<const std::byte> file, const std::string& name) {
  std::vector<std::size_t> numbers(read_npy_front(file, name).pictures);
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  return numbers;
}

FilePicture read_npy(std::span<const std::byte> file, const std::string& name, std::size_t number) {
  const NpyFront front = read_npy_front(file, name);
  if (number >= front.pictures) fail(name, "it was cut off");
  Picture picture(front.shape, front.type, front.type == ValueType::code8 ? 255 : 65'535);
  const auto bytes = file.subspan(front.begin + number * picture.bytes.size(), picture.bytes.size());
  std::ranges::copy(bytes, picture.bytes.begin());
  return {std::move(picture)};
}

void write_npy(OutputFile& file, const Picture& picture, const std::string&, const FileWishes&) {
  file.write(front_text(picture, "").append(as_text(picture.bytes)));
}

// Several as [layers, height, width].
void write_npy_layers(OutputFile& file, std::span<const PictureLayer> layers) {
  std::string text = front_text(layers.front().values, format("{}, ", layers.size()));
  for (const PictureLayer& layer : layers) text += as_text(layer.values.bytes);
  file.write(text);
}

}  // namespace

constinit const inputs::InputKind inputs::kNumpy{
    .name = "NumPy", .starts = {kMagic}, .extensions = " .npy ",
    .said = {"none", "none", "integers as stored, white 255 or 65535; floats as of OpenEXR", "none", "none",
             "an axis before height and width; a last one of 1 or 3 is channels"},
    .has_tags = true, .read = read_npy, .places = numbers_of_pictures,
    .written = {{.extension = ".npy", .holds_light = true, .holds_double = true, .is_silent = true, .write = write_npy,
                 .write_layers = write_npy_layers}}};

}  // namespace nutik
