// What is said of a clip whose pictures are not those that it announces.
#include "session/clips/encoding.hpp"

#include <gtest/gtest.h>

#include "session/made_clip.hpp"
#include "support/scratch.hpp"

namespace nutik {
namespace {

std::vector<std::string> warnings_of(std::uint64_t pictures, std::uint64_t announced) {
  const test::Scratch scratch;
  SourceRequest source;
  source.path = "clip";
  const EncodedCapture encoded = encode(
      source, [&] { return std::make_unique<test::MadeClip>(pictures, announced); }, {scratch / "c.tik"},
      MemoryBudget::of_machine());
  EXPECT_EQ(encoded.timeline.sample_count(), pictures);
  return encoded.warnings;
}

TEST(Encoding, SaysThatPicturesAreMissing) {
  EXPECT_EQ(warnings_of(7, 10),
            std::vector<std::string>{
                "clip announces 10 pictures and 7 could be decoded: if some within are damaged, "
                "those after them have the times of others"});
}

TEST(Encoding, SaysThatThereAreMorePicturesThanAnnounced) {
  const auto warnings = warnings_of(7, 6);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(warnings[0].starts_with("clip announces 6 pictures and 7 could be decoded: ")) << warnings[0];
}

TEST(Encoding, SaysNothingOfAClipThatIsWholeOrAnnouncesNothing) {
  EXPECT_EQ(warnings_of(7, 7), std::vector<std::string>{});
  EXPECT_EQ(warnings_of(7, 0), std::vector<std::string>{});
}

}  // namespace
}  // namespace nutik
