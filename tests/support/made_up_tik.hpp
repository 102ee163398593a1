// A .tik whose checksums are right, whatever it says.
#pragma once

#include <cstring>
#include <filesystem>
#include <vector>

#include "tik/writer.hpp"

namespace nutik::test {

// One tile of 8 x 8 grey pixels in one block of 16 samples, at 10 a second: an entry of the directory and a body.
struct MadeUpTile {
  static constexpr std::uint32_t kSamples = 16;

  std::uint32_t count;  // as TileEntry has it
  std::vector<std::byte> body;

  // Rows, or slots, all of one code, at these sample numbers. Slots have the same ones at every pixel but `odd_lane`.
  static MadeUpTile rows(const std::vector<std::uint8_t>& samples) {
    MadeUpTile tile{static_cast<std::uint32_t>(samples.size()), {}};
    for (const std::uint8_t sample : samples) tile.body.push_back(std::byte{sample});
    tile.body.resize(kBlockAlignment);
    for (std::size_t row = 0; row < samples.size(); ++row) tile.add_codes(row);
    return tile;
  }
  static MadeUpTile slots(const std::vector<std::uint8_t>& samples, std::uint32_t odd_lane,
                          const std::vector<std::uint8_t>& odd_samples) {
    MadeUpTile tile{TileEntry::kRecordsFlag | static_cast<std::uint32_t>(samples.size()), {}};
    tile.add_codes(0);
    for (std::size_t slot = 0; slot < samples.size(); ++slot) {
      for (std::uint32_t lane = 0; lane < kTilePixels; ++lane) {
        tile.body.push_back(std::byte{lane == odd_lane ? odd_samples[slot] : samples[slot]});
      }
      tile.add_codes(slot + 1);
    }
    return tile;
  }

 private:
  void add_codes(std::size_t row) {
    body.insert(body.end(), kTilePixels, static_cast<std::byte>(20 * (row + 1)));
  }
};

// `rate` is what its text says of the rate.
inline void write_made_up_tik(const std::filesystem::path& path, const MadeUpTile& tile,
                              const tik::Codec& codec, const std::string& rate = "10") {
  tik::Header header;
  header.capture.shape = {8, 8, 1};
  header.rate = Rational::parse(rate, "rate");
  header.codec = codec.text();
  tik::Writer writer(path, header, codec, std::vector<std::byte>(64, std::byte{20}));
  std::vector<std::byte> payload(kBlockAlignment);
  const TileEntry entry{1, tile.count};
  std::memcpy(payload.data(), &entry, sizeof entry);
  payload.insert(payload.end(), tile.body.begin(), tile.body.end());
  writer.append({{0, MadeUpTile::kSamples}, payload, 0});
  writer.finish(Timeline::constant({10, 1}, header.shutter_angle, MadeUpTile::kSamples));
}

}  // namespace nutik::test
