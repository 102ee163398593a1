// OpenEXR: one part of scan lines, channels R, G and B or Y, and of layers name.Y, packed by ZIP without loss.
#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <exception>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/source_text.hpp"
#include "capture/text.hpp"
#include "media/stills/picture_text.hpp"
#include "media/stills/stills.hpp"
#include "system/mapped_file.hpp"

namespace nutik::stills {
namespace {

// What OpenEXR writes, which goes back to fill in where its lines lie. It writes the last of that where it cannot
// throw: what failed is kept.
class FileStream final : public Imf::OStream {
 public:
  explicit FileStream(OutputFile& file) : Imf::OStream(file.temporary_path().c_str()), file_(file) {}

  void write(const char text[], int count) override {
    const auto bytes = std::as_bytes(std::span(text, static_cast<std::size_t>(count)));
    try {
      if (at_ == file_.size()) {
        file_.write(bytes);
      } else {
        file_.replace(at_, bytes);
      }
    } catch (...) {
      failure_ = std::current_exception();
      throw;
    }
    at_ += bytes.size();
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t position) override { at_ = position; }

  void check() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  OutputFile& file_;
  std::uint64_t at_ = 0;
  std::exception_ptr failure_;
};

Imf::Header header_of(const Picture& picture, const std::string& text) {
  const Shape& shape = picture.shape;
  Imf::Header header(static_cast<int>(shape.width), static_cast<int>(shape.height),
                     static_cast<float>(picture.pixel_aspect.value()), Imath::V2f(0, 0), 1.0F,
                     Imf::INCREASING_Y, Imf::ZIP_COMPRESSION);
  const auto& xy = chromaticities(picture.primaries);
  const auto point = [&](std::size_t i) {
    return Imath::V2f(static_cast<float>(xy[i][0]), static_cast<float>(xy[i][1]));
  };
  Imf::addChromaticities(header, {point(0), point(1), point(2), point(3)});
  if (picture.exposed_ns) {
    Imf::addExpTime(header, static_cast<float>(static_cast<double>(*picture.exposed_ns) / kSecondNs));
  }
  if (!text.empty()) header.insert(kPictureTextKeyword, Imf::StringAttribute(text));
  return header;
}

// Throws where a value is larger than a half holds: it would become infinite.
std::vector<half> halves(const Picture& picture) {
  const auto values = picture.values<float>();
  std::vector<half> result(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    result[i] = half(values[i]);
    if (result[i].isFinite()) continue;
    const std::size_t pixel = i / picture.shape.channels;
    throw OutputError(
        format("pixel {},{} has light {:.6g}, and 16-bit floating point ends at {:.0f}; write 32 bits",
               pixel % picture.shape.width, pixel / picture.shape.width, values[i], HALF_MAX),
        {Setting::depth});
  }
  return result;
}

// How many bytes the value of an attribute takes by its type: OpenEXR reads these, whatever is stated. None: as many as
// are stated.
std::optional<std::uint64_t> value_bytes_of(std::string_view type, std::string_view value) {
  using Fixed = std::pair<std::string_view, std::uint64_t>;
  constexpr Fixed kFixed[] = {{"box2i", 16},        {"box2f", 16},      {"chromaticities", 32}, {"compression", 1},
                              {"deepImageState", 1}, {"double", 8},     {"envmap", 1},          {"float", 4},
                              {"int", 4},           {"keycode", 28},    {"lineOrder", 1},       {"m33f", 36},
                              {"m33d", 72},         {"m44f", 64},       {"m44d", 128},          {"rational", 8},
                              {"tiledesc", 9},      {"timecode", 8},    {"v2i", 8},             {"v2f", 8},
                              {"v2d", 16},          {"v3i", 12},        {"v3f", 12},            {"v3d", 24}};
  if (const auto* fixed = std::ranges::find(kFixed, type, &Fixed::first); fixed != std::end(kFixed))
    return fixed->second;
  const auto number = [&](std::size_t at) {
    std::uint64_t read = 0;
    for (std::size_t i = 0; i < 4 && at + i < value.size(); ++i)
      read |= std::uint64_t{static_cast<unsigned char>(value[at + i])} << (8 * i);
    return read;
  };
  if (type == "preview")  // width, height, and four bytes for each pixel
    return std::max(number(0), number(4)) > value.size() ? UINT64_MAX : 8 + 4 * number(0) * number(4);
  std::uint64_t at = 0;
  if (type == "chlist") {  // names, each with 16 bytes, and an empty one
    constexpr std::uint64_t kChannelBytes = 16;
    while (at < value.size() && value[at] != '\0')
      at = std::min<std::uint64_t>(value.find('\0', at), value.size()) + 1 + kChannelBytes;
    return at + 1;
  }
  if (type == "stringvector") {
    while (at < value.size()) at += 4 + number(at);
    return at;
  }
  return std::nullopt;
}

// OpenEXR makes room for as many as 256 rows before it reads the first.
void check_rows(std::uint64_t width, std::uint64_t channels) {
  constexpr std::uint64_t kMostValues = 1 << 17;
  if (width > kMostValues || width * channels > kMostValues)
    throw InputError(format("its rows have {} pixels of {} channels, more than are read", width, channels));
}

// Each attribute of each header must lie within the file: OpenEXR makes room for what it is said to have, and then
// reads.
void check_attributes(std::string_view bytes) {
  constexpr std::size_t kMagicAndVersion = 8, kSizeBytes = 4, kFlags = 5;
  constexpr char kSeveralParts = 0x10;  // a header each, until an empty one
  const bool several_parts = bytes.size() > kFlags && (bytes[kFlags] & kSeveralParts) != 0;
  std::size_t at = kMagicAndVersion;
  const auto in_header = [&] { return at < bytes.size() && bytes[at] != '\0'; };
  std::uint64_t width = 0, channels = 1;
  do {
    while (in_header()) {
      std::string_view type;
      for (int word = 0; word < 2; ++word) {  // name and type
        const std::size_t end = bytes.find('\0', at);
        if (end == std::string_view::npos) throw InputError("its header has no end");
        type = bytes.substr(at, end - at);
        at = end + 1;
      }
      if (bytes.size() - at < kSizeBytes) throw InputError("its header has no end");
      std::uint32_t size = 0;
      for (std::size_t i = 0; i < kSizeBytes; ++i) {
        size |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
      }
      at += kSizeBytes;
      if (size > bytes.size() - at) {
        throw InputError(format("an attribute of {} bytes does not fit into its {} bytes", size, bytes.size()));
      }
      if (const auto needed = value_bytes_of(type, bytes.substr(at, size)); needed && *needed != size)
        throw InputError(format("an attribute has {} bytes, and by its type {}", size, *needed));
      if (type == "box2i") {
        const auto corner = [&](std::size_t number) {
          std::int32_t value = 0;
          std::memcpy(&value, bytes.data() + at + number * sizeof value, sizeof value);
          return std::int64_t{value};
        };
        width = std::max(width, static_cast<std::uint64_t>(std::max<std::int64_t>(corner(2) - corner(0) + 1, 0)));
      }
      // A channel has 17 bytes and more.
      if (type == "chlist") channels = std::max<std::uint64_t>(channels, size / 18 + 1);
      check_rows(width, channels);
      at += size;
    }
    ++at;
  } while (several_parts && in_header());
}

// With the channels of a buffer.
void write_file(OutputFile& file, const Imf::Header& header, const Imf::FrameBuffer& buffer) {
  FileStream stream(file);
  try {
    Imf::OutputFile output(stream, header, 0);
    output.setFrameBuffer(buffer);
    output.writePixels(header.dataWindow().max.y + 1);
  } catch (const std::exception& error) {
    stream.check();
    throw OutputError(format("the OpenEXR file cannot be written: {}", error.what()));
  }
  stream.check();
}

// Whether it is a channel of write_exr_layers(), which gives each layer an attribute of its name.
bool is_layer(const Imf::Header& header, std::string_view channel) {
  if (!channel.ends_with(".Y")) return false;
  channel.remove_suffix(2);
  return header.findTypedAttribute<Imf::StringAttribute>(std::string(channel)) != nullptr;
}

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 8;
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i)
    list += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + printable(names[i]);
  return list + (names.size() > kMost ? format(" and {} more", names.size() - kMost) : "");
}

// The channels of a picture of light, in a raster's order, and what is left out beside these. Throws where they are
// none: Y has no colour beside RY and BY.
std::pair<std::vector<std::string>, std::string> channels_of(const Imf::Header& header) {
  const Imf::ChannelList& channels = header.channels();
  std::vector<std::string> all, rest;
  for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
    if (!is_layer(header, channel.name())) all.emplace_back(channel.name());
  }
  const auto has = [&](const char* name) { return channels.findChannel(name) != nullptr; };
  std::vector<std::string> light = all;
  std::erase(light, "A");
  if (has("R") && has("G") && has("B")) {
    light = {"R", "G", "B"};
  } else if (has("Y") && !has("RY") && !has("BY")) {
    light = {"Y"};
  } else if (light.size() != 1) {
    throw InputError(format("its channels are {}; R, G and B, or Y, or one of grey, are read: save it with these",
                            listed(all)));
  }
  std::ranges::copy_if(all, std::back_inserter(rest),
                       [&](const std::string& name) { return std::ranges::find(light, name) == light.end(); });
  if (rest.empty()) return {light, ""};
  return {light, (rest.size() == 1 ? "channel " : "channels ") + listed(rest)};
}

NamedPrimaries named_primaries(const Imf::Header& header) {
  if (!Imf::hasChromaticities(header)) return {};
  const Imf::Chromaticities& named = Imf::chromaticities(header);
  const auto at = [](const Imath::V2f& point) { return std::array{double{point.x}, double{point.y}}; };
  return primaries_at({at(named.red), at(named.green), at(named.blue), at(named.white)});
}

}  // namespace

void write_exr(OutputFile& file, const Picture& picture, const std::string& text, bool as_half) {
  const Shape& shape = picture.shape;
  Imf::Header header = header_of(picture, text);
  const Imf::PixelType type = as_half ? Imf::HALF : Imf::FLOAT;
  const std::size_t value = as_half ? sizeof(half) : sizeof(float), pixel = value * shape.channels;
  const std::vector<half> short_values = as_half ? halves(picture) : std::vector<half>();
  // OpenEXR only reads it.
  auto* first = as_half ? reinterpret_cast<char*>(const_cast<half*>(short_values.data()))
                        : reinterpret_cast<char*>(const_cast<std::byte*>(picture.bytes.data()));
  Imf::FrameBuffer buffer;
  for (std::uint32_t channel = 0; channel < shape.channels; ++channel) {
    constexpr const char* kColour[] = {"R", "G", "B"};
    const char* name = shape.channels == 1 ? "Y" : kColour[channel];
    header.channels().insert(name, Imf::Channel(type));
    buffer.insert(name, Imf::Slice(type, first + channel * value, pixel, pixel * shape.width));
  }
  write_file(file, header, buffer);
}

void write_exr_layers(OutputFile& file, std::span<const PictureLayer> layers) {
  Imf::Header header = header_of(layers.front().values, {});
  Imf::FrameBuffer buffer;
  for (const PictureLayer& layer : layers) {
    header.insert(layer.name, Imf::StringAttribute(layer.text));
    const std::string name = &layer == layers.data() ? "Y" : layer.name + ".Y";
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    // OpenEXR only reads it.
    auto* first = reinterpret_cast<char*>(const_cast<std::byte*>(layer.values.bytes.data()));
    buffer.insert(name, Imf::Slice(Imf::FLOAT, first, sizeof(float), sizeof(float) * layer.values.shape.width));
  }
  write_file(file, header, buffer);
}

NamedPrimaries primaries_at(const std::array<std::array<double, 2>, 4>& points) {
  constexpr double kAgree = 5e-4;
  for (const Primaries known : all_primaries()) {
    double furthest = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto& [x, y] = chromaticities(known)[i];
      furthest = std::max({furthest, std::abs(x - points[i][0]), std::abs(y - points[i][1])});
    }
    if (furthest < kAgree) return {known, {}};
  }
  std::string at;
  for (std::size_t i = 0; i < 4; ++i) {
    constexpr const char* kNames[] = {"red", ", green", ", blue", ", white"};
    at += format("{} at {:.6g} {:.6g}", kNames[i], points[i][0], points[i][1]);
  }
  return {std::nullopt, at};
}

ExrPicture read_exr(const std::filesystem::path& file) {
  constexpr std::int64_t kLargestSide = 1 << 20;
  constexpr std::uint64_t kSmall = 64 << 20, kMaxExpansion = 2560;
  try {
    const MappedFile mapped(file);
    check_attributes(as_text(mapped.bytes()));
    Imf::InputFile input(file.c_str(), 0);
    const Imf::Header& header = input.header();
    const Imath::Box2i window = header.dataWindow();
    if (window != header.displayWindow())
      throw InputError("its pixels are not those of its picture (data and display window)");
    const auto [names, left_out] = channels_of(header);
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1,
                       height = std::int64_t{window.max.y} - window.min.y + 1;
    const Shape shape{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height),
                      static_cast<std::uint32_t>(names.size())};
    const std::uint64_t largest = std::max(kSmall, mapped.bytes().size() * kMaxExpansion);
    const bool is_possible =
        std::max(width, height) <= kLargestSide && shape.value_count() * sizeof(float) <= largest;
    if (!is_possible) {
      throw InputError(format("it states {} x {} pixels, which its {} bytes do not hold; it is damaged", width, height,
                              mapped.bytes().size()));
    }
    ExrPicture read{Picture(shape, ValueType::light32, 0), named_primaries(header), left_out,
                    double{header.pixelAspectRatio()}};
    constexpr std::size_t kValue = sizeof(float);
    const std::size_t pixel = kValue * names.size(), row = pixel * shape.width;
    // OpenEXR counts from its own corner, and adds what is before it.
    char* const first = reinterpret_cast<char*>(read.light.bytes.data()) -
                        window.min.x * static_cast<std::ptrdiff_t>(pixel) -
                        window.min.y * static_cast<std::ptrdiff_t>(row);
    Imf::FrameBuffer buffer;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (const Imf::Channel& channel = header.channels()[names[i]]; channel.xSampling != 1 || channel.ySampling != 1)
        throw InputError(format("its channel {} has fewer pixels than the picture", names[i]));
      buffer.insert(names[i], Imf::Slice(Imf::FLOAT, first + i * kValue, pixel, row));
    }
    input.setFrameBuffer(buffer);
    input.readPixels(window.min.y, window.max.y);
    return read;
  } catch (const std::exception& error) {
    throw InputError(format("{} cannot be read: {}", file.string(), error.what()));
  }
}

std::optional<std::string> read_exr_text(const std::filesystem::path& file, const char* keyword) {
  try {
    const MappedFile mapped(file);
    check_attributes(as_text(mapped.bytes()));
    const Imf::InputFile input(file.c_str(), 0);
    const auto* text = input.header().findTypedAttribute<Imf::StringAttribute>(keyword);
    if (text == nullptr) return std::nullopt;
    if (text->value().size() > kMaxPictureTextBytes) {
      throw InputError(format("its text has {} bytes", text->value().size()));
    }
    return text->value();
  } catch (const std::exception& error) {
    throw InputError(format("{} cannot be read: {}", file.string(), error.what()));
  }
}

}  // namespace nutik::stills
