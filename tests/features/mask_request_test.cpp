#include "features/masks/mask_making.hpp"

#include <gtest/gtest.h>

namespace nutik {
namespace {

MaskStep step(const Selection& selection, std::uint8_t tag) {
  return {"--step", tag, selection, std::nullopt, {}};
}

MaskRequest request(std::vector<MaskStep> steps, MaskSize size = {4, 3}) {
  MaskRequest request;
  request.size = NamedSize{"--size", size};
  request.steps = std::move(steps);
  return request;
}

NamedPicture grey(const std::string& name, std::vector<std::uint8_t> codes) {
  Picture picture({static_cast<std::uint32_t>(codes.size()), 1, 1}, ValueType::code8, 255);
  std::ranges::copy(codes, picture.values<std::uint8_t>().begin());
  return {name, Shared(std::move(picture))};
}

TEST(MaskRequest, KnowsWhatItReads) {
  EXPECT_FALSE(step(select::Whole{}, 1).reads_capture());
  EXPECT_TRUE(step(select::Motion{}, 1).reads_capture());
  EXPECT_TRUE(step(select::Threshold{StatedTime::of_pictures(3), 0, 1, false}, 1).reads_capture());
  const MaskStep mixed = step(select::Difference{grey("a.png", {1}), StatedTime::of_pictures(3)}, 1);
  EXPECT_TRUE(mixed.reads_capture());
  ASSERT_EQ(mixed.pictures().size(), 1u);
  EXPECT_EQ(mixed.pictures()[0]->name, "a.png");
  EXPECT_FALSE(step(select::Difference{grey("a.png", {1}), grey("b.png", {1})}, 1).reads_capture());
}

TEST(MaskMaking, PaintsStepsInOrder) {
  MaskStep changed = step(select::Rectangle{{0, 0}, 2, 3}, 9);
  changed.changes = {{RegionChange::Kind::invert, 0.0, {}},
                     {RegionChange::Kind::within, 0.0, {{0, 0}, 3, 3}}};
  const MadeMask made = make_mask(request({step(select::Whole{}, 1), changed}), nullptr, "");
  EXPECT_EQ(made.mask, (Mask{4, 3, {1, 1, 9, 1, 1, 1, 9, 1, 1, 1, 9, 1}}));
  ASSERT_EQ(made.steps.size(), 2u);
  EXPECT_EQ(made.steps[1].pixel_count, 3u);
}

TEST(MaskMaking, TakesThePicturesSizeWhereNothingElseIsKnown) {
  MaskRequest unsized;
  unsized.steps = {step(select::Threshold{grey("a.png", {10, 200, 30}), 100, 255, false}, 5)};
  EXPECT_EQ(make_mask(unsized, nullptr, "").mask, (Mask{3, 1, {0, 5, 0}}));
  EXPECT_THROW(static_cast<void>(make_mask(MaskRequest{}, nullptr, "")), UsageError);
  unsized.size = NamedSize{"--size", {4, 1}};
  EXPECT_THROW(static_cast<void>(make_mask(unsized, nullptr, "")), InputError);
}

TEST(MaskMaking, RefusesStepsThatLackTheirCapture) {
  EXPECT_THROW(static_cast<void>(make_mask(request({step(select::Motion{}, 1)}), nullptr, "")), UsageError);
  const MaskStep mixed = step(select::Difference{grey("a.png", {1}), StatedTime::of_pictures(3)}, 1);
  EXPECT_THROW(static_cast<void>(make_mask(request({mixed}), nullptr, "")), UsageError);
}

}  // namespace
}  // namespace nutik
