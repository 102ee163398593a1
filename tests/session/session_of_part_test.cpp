// A capture with fewer pixels has the samples and times of the whole one.
#include "session/live/session_of_part.hpp"

#include <gtest/gtest.h>

#include "capture/light_means.hpp"
#include "imev/each_block.hpp"
#include "imev/sample_cursor.hpp"
#include "support/random_case.hpp"
#include "support/scratch.hpp"
#include "support/tik_files.hpp"

namespace nutik::test {
namespace {

class SessionOfPart : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(SessionOfPart, HasTheSamplesAndTimesOfTheWholeOne) {
  RandomCase random(GetParam());
  // What was kept is shown, not what was filmed.
  random.capture.noise = {};
  const Shape& whole = random.capture.shape;
  const Shape shape{whole.width / 2, whole.height / 2, whole.channels};
  const Scratch scratch;
  SourceRequest source;
  source.path = write_tik(random, {tik::CodecId::zstd, 0}, scratch);
  Session session(source);
  const auto reduced = session_of_part(session, {.scale = ClipScale{2}});
  EXPECT_EQ(reduced->format().shape, shape);
  EXPECT_EQ(reduced->format().white_code, random.capture.white_code);
  EXPECT_EQ(reduced->format().transfer, random.capture.transfer);
  const Timeline &is = reduced->timeline(), &should = session.timeline();
  ASSERT_EQ(is.sample_count(), should.sample_count());
  EXPECT_EQ(is.duration_ns(), should.duration_ns());
  for (std::uint64_t sample = 0; sample < is.sample_count(); ++sample) {
    ASSERT_EQ(is.start_ns(sample), should.start_ns(sample)) << "sample " << sample;
    ASSERT_EQ(is.end_ns(sample), should.end_ns(sample)) << "sample " << sample;
  }

  const Transfer& transfer = random.capture.transfer;
  const std::uint32_t white = random.capture.white_code;
  const LightMeans means(random.capture.shape, {0, 0, 2 * shape.width, 2 * shape.height}, shape,
                         transfer.light_of_codes(white), LightCodes(transfer, white));
  std::vector<std::byte> wanted(reduced->format().sample_bytes()), read(wanted.size());
  for_each_block(reduced->capture(), [&](const BlockView& block) {
    SampleCursor cursor(shape, block);
    const SampleRange samples = block.extent().range();
    for (std::uint64_t sample = samples.first; sample < samples.last; ++sample) {
      cursor.go_to(static_cast<std::uint32_t>(sample - samples.first));
      cursor.read(read);
      means.take(random.rasters[sample], random.capture.code_bytes, wanted, random.capture.code_bytes, 0, shape.height);
      ASSERT_EQ(read, wanted) << random.text() << ", sample " << sample;
    }
  });
}

TEST_P(SessionOfPart, OfSomePicturesHasThoseThatBeginBetweenTwoMoments) {
  RandomCase random(GetParam());
  random.capture.noise = {};
  const Scratch scratch;
  SourceRequest source;
  source.path = write_tik(random, {tik::CodecId::zstd, 0}, scratch);
  Session session(source);
  const Timeline& whole = session.timeline();
  if (whole.sample_count() < 3) return;  // no picture lies between others
  const auto taken = session_of_part(
      session, {.from = ClipMoment{whole.start_ns(0) + 1}, .to = ClipMoment{whole.start_ns(whole.sample_count() - 1)}});
  const Timeline& is = taken->timeline();
  ASSERT_EQ(is.sample_count(), whole.sample_count() - 2);
  const auto& of_clip = taken->capture().header().part;
  ASSERT_TRUE(of_clip);
  EXPECT_EQ(of_clip->start_ns, whole.start_ns(1));
  std::vector<std::byte> read(taken->format().sample_bytes());
  for_each_block(taken->capture(), [&](const BlockView& block) {
    SampleCursor cursor(taken->format().shape, block);
    const SampleRange samples = block.extent().range();
    for (std::uint64_t sample = samples.first; sample < samples.last; ++sample) {
      cursor.go_to(static_cast<std::uint32_t>(sample - samples.first));
      cursor.read(read);
      ASSERT_EQ(read, random.rasters[sample + 1]) << random.text() << ", sample " << sample;
    }
  });
}

// Captures with two rows or more.
INSTANTIATE_TEST_SUITE_P(Captures, SessionOfPart, testing::Values(0, 1, 2, 3, 4, 6, 8, 9, 10, 11));

}  // namespace
}  // namespace nutik::test
