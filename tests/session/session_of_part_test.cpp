// A capture with fewer pixels has the samples and times of the whole one.
#include "session/live/session_of_part.hpp"

#include <gtest/gtest.h>

#include "capture/light_means.hpp"
#include "imev/each_block.hpp"
#include "imev/sample_cursor.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"
#include "support/scratch.hpp"
#include "support/tik_files.hpp"

namespace nutik::test {
namespace {

// What a part has are the samples of a case from one on.
void expect_samples_from(std::uint64_t first, const RandomCase& random, Session& part) {
  std::vector<std::byte> read(part.format().sample_bytes());
  for_each_block(part.capture(), [&](const BlockView& block) {
    SampleCursor cursor(part.format().shape, block);
    const SampleRange samples = block.extent().range();
    for (std::uint64_t sample = samples.first; sample < samples.last; ++sample) {
      cursor.go_to(static_cast<std::uint32_t>(sample - samples.first));
      cursor.read(read);
      ASSERT_EQ(read, random.rasters[first + sample]) << random.text() << ", sample " << sample;
    }
  });
}

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
  expect_samples_from(1, random, *taken);
}

// Samples 2, 3 and 4 were made between pictures 1 and 2, samples 7 and 8 between pictures 3 and 4.
TEST(SessionOfPartWithMadeSamples, CountsThePicturesThatWereFilmed) {
  RandomCase random(2);
  random.capture.noise = {};
  const MadeSamples made{.after = {0, 3, 0, 2, 0, 0}};
  const auto filmed = [](std::uint64_t count) { return Timeline::constant({100, 1}, {180, 1}, count); };
  random.timeline = made.times(filmed(6));
  const std::size_t count = random.rasters.size();
  ASSERT_GE(count, 2u);
  while (random.rasters.size() < made.total()) random.rasters.push_back(random.rasters[random.rasters.size() - count]);
  random.rasters.resize(made.total());
  const Scratch scratch;
  SourceRequest source;
  source.path = write_saying(tik::Reader(write_tik(random, {tik::CodecId::zstd, 0}, scratch)), scratch / "made.tik",
                             [&](tik::Header& header) {
                               header.made = made;
                               header.filmed = tik::filmed_times(filmed(6));
                             });
  Session session(source);
  ASSERT_EQ(session.timeline(), random.timeline);
  const auto reduced = session_of_part(session, {.scale = ClipScale{2}});
  EXPECT_EQ(reduced->timeline(), random.timeline);
  EXPECT_EQ(reduced->capture().header().made, made);

  const auto expect_part = [&](ClipMoment from, ClipMoment to, std::uint64_t sample, const MadeSamples& its) {
    const auto part = session_of_part(session, {.from = from, .to = to});
    EXPECT_EQ(part->timeline(), its.times(filmed(its.after.size())));
    EXPECT_EQ(part->capture().header().made, its);
    EXPECT_EQ(part->capture().header().part->start_ns,
              session.timeline().pictures().start_ns(part->capture().header().part->first));
    expect_samples_from(sample, random, *part);
  };
  expect_part({1, true}, {4, true}, 1, {.after = {3, 0, 0}});
  expect_part({15'000'000}, {40'000'001}, 5, {.after = {0, 2, 0}});
  const auto refused = [&](ClipMoment from, ClipMoment to) {
    return message_of<UsageError>([&] { static_cast<void>(session_of_part(session, {.from = from, .to = to})); });
  };
  expect_says(refused({11'000'000}, {19'000'000}), "no picture begins between the two");
  expect_says(refused({6, true}, {7, true}), "has 6 pictures (0f … 5f");
}

// Captures with two rows or more.
INSTANTIATE_TEST_SUITE_P(Captures, SessionOfPart, testing::Values(0, 1, 2, 3, 4, 6, 8, 9, 10, 11));

}  // namespace
}  // namespace nutik::test
