// Files that say more than they hold.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>

#include "support/bytes.hpp"

namespace nutik::test {

inline std::string png_chunk(const std::string& type, const std::string& data) {
  const std::string summed = type + data;
  const auto sum = crc32(0, reinterpret_cast<const Bytef*>(summed.data()), static_cast<uInt>(summed.size()));
  return big_endian(data.size(), 4) + summed + big_endian(sum, 4);
}

// With a chunk behind the first, which tells the size.
inline std::string with_chunk(const std::string& png, const std::string& name, const std::string& data) {
  constexpr std::size_t kFirstEnd = 33;
  return png.substr(0, kFirstEnd) + png_chunk(name, data) + png.substr(kFirstEnd);
}

// A grey PNG of 8 bits that states this size, and has so many rows of it, all black.
inline std::string black_png(std::uint32_t width, std::uint32_t height, std::uint32_t rows) {
  std::string packed;
  z_stream stream{};
  deflateInit(&stream, 9);
  std::string row(width + 1, '\0'), room(1 << 16, '\0');
  for (std::uint32_t y = 0; y <= rows; ++y) {
    stream.next_in = reinterpret_cast<Bytef*>(row.data());
    stream.avail_in = y < rows ? static_cast<uInt>(row.size()) : 0;
    do {
      stream.next_out = reinterpret_cast<Bytef*>(room.data());
      stream.avail_out = static_cast<uInt>(room.size());
      deflate(&stream, y < rows ? Z_NO_FLUSH : Z_FINISH);
      packed.append(room, 0, room.size() - stream.avail_out);
    } while (stream.avail_out == 0);
  }
  deflateEnd(&stream);
  const std::string header = big_endian(width, 4) + big_endian(height, 4) + std::string("\x08\0\0\0\0", 5);
  return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", header) + png_chunk("IDAT", packed) + png_chunk("IEND", "");
}

// A grey TIFF of 16 bits, packed by `compression` (5 LZW, 8 Deflate, 32773 PackBits, 1 not at all), with a few bytes
// for pixels.
inline std::string tiny_tiff(std::uint32_t width, std::uint32_t height, std::uint16_t compression) {
  const std::string data = compression == 8 ? std::string("\x78\x9c\x63\x60\x60\x00\x00\x00\x03\x00\x01", 11)
                                            : std::string(40, '\x80');
  std::string file("II*\0", 4);
  file += little_endian(8 + data.size(), 4) + data;
  const auto size = static_cast<std::uint32_t>(data.size());
  const std::uint32_t entries[][3] = {{256, 4, width},       {257, 4, height}, {258, 3, 16},
                                      {259, 3, compression}, {262, 3, 1},      {273, 4, 8},
                                      {277, 3, 1},           {278, 4, height}, {279, 4, size}};
  file += little_endian(std::size(entries), 2);
  for (const auto& [tag, type, value] : entries) {
    file += little_endian(tag, 2) + little_endian(type, 2) + little_endian(1, 4) + little_endian(value, 4);
  }
  return file + little_endian(0, 4);
}

}  // namespace nutik::test
