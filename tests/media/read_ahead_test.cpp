#include "media/read_ahead.hpp"

#include <gtest/gtest.h>

#include <atomic>

#include "capture/error.hpp"

namespace nutik {
namespace {

// Samples whose bytes are their number; damaged from one on.
class NumberedClip final : public Clip {
 public:
  NumberedClip(std::uint64_t samples, std::uint64_t damaged) : samples_(samples), damaged_(damaged) {
    info_.format.shape = {40, 10, 1};
  }
  [[nodiscard]] const ClipInfo& info() const override { return info_; }
  bool read(std::span<std::byte> raster) override {
    if (read_ == damaged_) throw InputError("damaged");
    if (read_ == samples_) return false;
    std::ranges::fill(raster, static_cast<std::byte>(read_++));
    return true;
  }
  [[nodiscard]] std::uint64_t samples_read() const { return read_; }

 private:
  ClipInfo info_;
  std::uint64_t samples_;
  std::uint64_t damaged_;
  std::atomic<std::uint64_t> read_ = 0;
};

constexpr std::uint64_t kWhole = ReadAhead::kAll;

TEST(ReadAhead, GivesEverySampleInOrderAndNoMoreThanAsked) {
  for (const std::uint64_t most : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{130}, kWhole}) {
    NumberedClip clip(200, kWhole);
    ReadAhead ahead(clip, most == 1 ? 0 : 4000, most);
    const std::uint64_t expected = std::min<std::uint64_t>(most, 200);
    std::uint64_t asked = 1;
    for (std::uint64_t k = 0; k < expected; asked = asked % 5 + 1) {
      const auto rasters = ahead.next(asked);
      ASSERT_FALSE(rasters.empty());
      ASSERT_LE(rasters.size(), asked);
      for (const std::span<const std::byte> raster : rasters) {
        ASSERT_EQ(raster.size(), 400u);
        EXPECT_EQ(raster.front(), static_cast<std::byte>(k));
        EXPECT_EQ(raster.back(), static_cast<std::byte>(k));
        ++k;
      }
    }
    EXPECT_TRUE(ahead.next(1).empty());
    EXPECT_TRUE(ahead.next(4).empty());
    EXPECT_EQ(clip.samples_read(), expected);
  }
}

TEST(ReadAhead, ThrowsWhatTheClipThrewAfterTheSamplesBeforeIt) {
  NumberedClip clip(200, 3);
  ReadAhead ahead(clip, 4000);
  EXPECT_EQ(ahead.next(2).size(), 2u);
  EXPECT_EQ(ahead.next(2).size(), 1u);
  EXPECT_THROW(static_cast<void>(ahead.next(2)), InputError);
}

TEST(ReadAhead, StopsWhereNobodyWantsMore) {
  NumberedClip clip(kWhole, kWhole);
  ReadAhead ahead(clip, 4000);
  EXPECT_FALSE(ahead.next(1).empty());
}

}  // namespace
}  // namespace nutik
