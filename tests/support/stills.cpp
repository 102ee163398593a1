#include "support/stills.hpp"

#include "support/random_case.hpp"

namespace nutik::test {

std::uint32_t code_of(const Picture& picture, std::uint64_t value) {
  return picture.type == ValueType::code8 ? picture.values<std::uint8_t>()[value]
                                          : picture.values<std::uint16_t>()[value];
}

namespace {

// Bytes in one order or the other.
class Bytes {
 public:
  explicit Bytes(bool big_endian) : big_endian_(big_endian) {}
  void add(std::uint32_t value, int count) {
    for (int i = 0; i < count; ++i) {
      const int shift = 8 * (big_endian_ ? count - 1 - i : i);
      text_ += static_cast<char>(value >> shift & 0xFF);
    }
  }
  void set(std::size_t at, std::uint32_t value) {
    Bytes number(big_endian_);
    number.add(value, 4);
    text_.replace(at, 4, number.text_);
  }
  [[nodiscard]] std::size_t size() const { return text_.size(); }
  std::string text_;

 private:
  bool big_endian_;
};

// A page's values as they lie in the file: row after row, each starting with a whole byte.
std::string tiff_values(const Picture& page, const TiffOptions& options, std::uint32_t first_channel,
                        std::uint32_t channels) {
  Bytes bytes(options.big_endian);
  const auto stated = static_cast<std::uint32_t>(options.max_sample_value);
  const std::uint32_t full = stated != 0 ? stated : (1u << options.bits) - 1;
  for (std::uint32_t y = 0; y < page.shape.height; ++y) {
    std::uint64_t window = 0;
    int held = 0;
    for (std::uint32_t i = 0; i < page.shape.width * channels; ++i) {
      const std::uint64_t at = (std::uint64_t{y} * page.shape.width + i / channels) * page.shape.channels +
                               first_channel + i % channels;
      const std::uint32_t code = code_of(page, at);
      const std::uint32_t value = options.inverted ? full - code : code;
      if (options.bits % 8 == 0) {
        bytes.add(value, options.bits / 8);
        continue;
      }
      window = window << options.bits | value;
      for (held += options.bits; held >= 8; held -= 8) bytes.add(window >> (held - 8) & 0xFF, 1);
    }
    if (held > 0) bytes.add(static_cast<std::uint32_t>(window << (8 - held)) & 0xFF, 1);
  }
  return bytes.text_;
}

}  // namespace

std::vector<Picture> random_stills(Shape shape, std::uint32_t white_code, int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Picture> stills;
  for (int k = 0; k < count; ++k) {
    Picture& still =
        stills.emplace_back(shape, white_code > 255 ? ValueType::code16 : ValueType::code8, white_code);
    for (std::uint64_t i = 0; i < shape.value_count(); ++i) {
      // Both ends are sure to occur.
      const auto code = static_cast<std::uint32_t>(i == 0   ? white_code
                                                   : i == 1 ? 0
                                                            : random.whole(0, white_code));
      if (white_code > 255) {
        still.values<std::uint16_t>()[i] = static_cast<std::uint16_t>(code);
      } else {
        still.values<std::uint8_t>()[i] = static_cast<std::uint8_t>(code);
      }
    }
  }
  return stills;
}

std::string netpbm_file(const Picture& picture, bool plain) {
  const bool colour = picture.shape.channels == 3;
  std::string text = plain ? colour ? "P3" : "P2" : colour ? "P6" : "P5";
  text += "\n# a comment\n" + std::to_string(picture.shape.width) + " " +
          std::to_string(picture.shape.height) + "\n" + std::to_string(picture.white_code) + "\n";
  for (std::uint64_t i = 0; i < picture.shape.value_count(); ++i) {
    const std::uint32_t code = code_of(picture, i);
    if (plain) {
      text += std::to_string(code) + (i % 12 == 11 ? "\n" : " ");
    } else {
      if (picture.white_code > 255) text += static_cast<char>(code >> 8);
      text += static_cast<char>(code & 0xFF);
    }
  }
  return text;
}

std::string difference(const std::vector<std::byte>& got, const Picture& want) {
  if (got.size() != want.bytes.size()) {
    return std::to_string(got.size()) + " bytes, expected " + std::to_string(want.bytes.size());
  }
  Picture read = want;
  read.bytes = got;
  for (std::uint64_t i = 0; i < want.shape.value_count(); ++i) {
    if (code_of(read, i) == code_of(want, i)) continue;
    return "value " + std::to_string(i) + ": " + std::to_string(code_of(read, i)) + ", expected " +
           std::to_string(code_of(want, i));
  }
  return {};
}

std::string tiff_file(const std::vector<Picture>& pages, const TiffOptions& options) {
  constexpr std::uint32_t kText = 2, kShort = 3, kLong = 4;
  Bytes file(options.big_endian);
  for (int i = 0; i < 2; ++i) file.add(options.big_endian ? 'M' : 'I', 1);
  file.add(42, 2);
  std::size_t link = file.size();  // where the next directory's offset belongs
  file.add(0, 4);
  for (const Picture& page : pages) {
    const std::uint32_t channels = page.shape.channels;
    const std::uint32_t planes = options.planar ? channels : 1;
    std::vector<std::uint32_t> offsets, sizes;
    for (std::uint32_t plane = 0; plane < planes; ++plane) {
      const std::string values = tiff_values(page, options, plane, channels / planes);
      if (file.size() % 2 != 0) file.add(0, 1);
      offsets.push_back(static_cast<std::uint32_t>(file.size()));
      sizes.push_back(static_cast<std::uint32_t>(values.size()));
      file.text_ += values;
    }
    for (std::size_t k = 1; options.in_one && k < pages.size(); ++k)
      file.text_ += tiff_values(pages[k], options, 0, channels);
    const auto list = [&](const std::vector<std::uint32_t>& values, int bytes) {
      if (file.size() % 2 != 0) file.add(0, 1);
      const auto at = static_cast<std::uint32_t>(file.size());
      for (const std::uint32_t value : values) file.add(value, bytes);
      return at;
    };
    const std::uint32_t offset_list = list(offsets, 4), size_list = list(sizes, 4);
    const std::uint32_t bit_list =
        list(std::vector<std::uint32_t>(channels, static_cast<std::uint32_t>(options.bits)), 2);
    const auto text = static_cast<std::uint32_t>(file.size());
    file.text_ += options.description + std::string(options.description.size() % 2 + 2, '\0');
    if (file.size() % 2 != 0) file.add(0, 1);
    file.set(link, static_cast<std::uint32_t>(file.size()));
    const auto alone = [&](std::uint32_t count, std::uint32_t value, std::uint32_t where) {
      return count == 1 ? value : where;
    };
    const auto bits = static_cast<std::uint32_t>(options.bits);
    std::map<std::uint32_t, std::array<std::uint32_t, 3>> entries = options.tags;  // type, count and value
    const auto entry = [&](std::uint32_t tag, std::uint32_t type, std::uint32_t count, std::uint32_t value) {
      entries.insert({tag, {type, count, value}});
    };
    entry(256, kLong, 1, page.shape.width);
    entry(257, kLong, 1, page.shape.height);
    entry(258, kShort, channels, channels == 2 ? bits * 0x10001 : alone(channels, bits, bit_list));  // two fit in
    entry(259, kShort, 1, 1);  // not compressed
    entry(262, kShort, 1, channels >= 3 ? 2 : options.inverted ? 0 : 1);
    if (!options.description.empty() && &page == pages.data())
      entry(270, kText, static_cast<std::uint32_t>(options.description.size() + 1), text);
    entry(273, kLong, planes, alone(planes, offsets[0], offset_list));
    if (options.orientation != 0) entry(274, kShort, 1, static_cast<std::uint32_t>(options.orientation));
    entry(277, kShort, 1, channels);
    entry(278, kLong, 1, page.shape.height);
    entry(279, kLong, planes, alone(planes, sizes[0], size_list));
    if (options.max_sample_value != 0) {
      entry(281, kShort, 1, static_cast<std::uint32_t>(options.max_sample_value));
    }
    entry(284, kShort, 1, options.planar ? 2 : 1);
    if (options.extra >= 0) entry(338, kShort, 1, static_cast<std::uint32_t>(options.extra));
    entry(339, kShort, 1, static_cast<std::uint32_t>(options.sample_format));
    file.add(static_cast<std::uint32_t>(entries.size()), 2);
    for (const auto& [tag, said] : entries) {
      const auto [type, count, value] = said;
      const bool is_short = type == kShort && count == 1;
      file.add(tag, 2);
      file.add(type, 2);
      file.add(count, 4);
      file.add(value, is_short ? 2 : 4);
      if (is_short) file.add(0, 2);
    }
    link = file.size();
    file.add(0, 4);
    if (options.in_one) break;
  }
  return file.text_;
}

}  // namespace nutik::test
