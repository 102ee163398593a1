// Previews expose those pixels in sight that a change may have changed.
#include "studio/live/live_view.hpp"

#include <QPainter>

#include "session/live/session_of_part.hpp"
#include "studio/live/changed_pixels.hpp"
#include "studio/regions/region_edits.hpp"
#include "studio_test.hpp"

namespace nutik::studio {
namespace {

constexpr std::uint32_t kWidth = 96, kHeight = 48;

Region box(const QRect& pixels) {
  return rectangle(kWidth, kHeight, {1.0 * pixels.x(), 1.0 * pixels.y()}, pixels.width(), pixels.height());
}

SharedMask mask_with(const QRect& pixels, std::uint8_t tag) {
  Mask mask = Mask::uniform(kWidth, kHeight, 0);
  paint(mask, box(pixels), tag);
  return Shared(MaskWithRegions(std::move(mask)));
}

class LiveViewTest : public StudioTest {
 protected:
  // Three regions with a function each, exposed; a drag has begun.
  void begin() {
    open_clip();
    for (const QRect& pixels : {QRect(0, 0, 96, 48), kLeft, kRight}) {
      if (pixels != QRect(0, 0, 96, 48)) add_region(document());
      paint_region(document(), box(pixels), document().selected_tag(), "Band");
      document().set_points(document().selected_tag(), {{0, 0.2}, {90'000'000, 1.0}, {200'000'000, 0.4}},
                            "Ramp");
    }
    right_ = document().selected_tag();
    session_ = std::make_shared<Session>(SourceRequest{.path = document().facts()->path.toStdString(),
                                                       .clip = {.rate = Rational::parse("100", "rate")}});
    QObject::connect(&live_, &LiveView::pictured, [this](const ShownPicture& picture) {
      if (shown_.isNull()) shown_ = QImage(kWidth, kHeight, QImage::Format_RGB32);
      QPainter(&shown_).drawImage(picture.place.topLeft(), picture.image);
      places_.push_back(picture.place);
    });
    live_.show(session_);
    ASSERT_TRUE(answered());
    document().begin_drag();
  }
  // What was exposed since.
  [[nodiscard]] QRect exposed() {
    places_.clear();
    EXPECT_TRUE(answered());
    QRect all;
    for (const QRect& place : places_) all |= place;
    return all;
  }
  [[nodiscard]] bool answered() {
    return QTest::qWaitFor([this] { return !live_.is_busy(); }, kMaxWaitMs);
  }
  void expect_what_all_together_would_show() {
    const DocumentState& state = document().state();
    const auto whole =
        session_->render(exposure_of(state, state.mask), screen_format(), {.precision = Precision::single_});
    EXPECT_EQ(difference(shown_, image_of(whole.picture)), "");
  }
  void ramp(std::uint8_t tag, double gain) {
    document().set_points(tag, {{0, gain}, {200'000'000, 0.3}}, "Ramp");
  }

  const QRect kLeft{10, 4, 20, 30}, kRight{60, 10, 30, 20};
  std::uint8_t right_ = 0;
  std::shared_ptr<Session> session_;
  QImage shown_;
  std::vector<QRect> places_;
  Jobs jobs_;
  LiveView live_{document(), jobs_};
};

TEST_F(LiveViewTest, ABrushExposesWhatItChangedAlone) {
  ASSERT_NO_FATAL_FAILURE(begin());
  for (const QRect& stroke : {QRect(20, 20, 8, 6), QRect(24, 22, 9, 9), QRect(70, 2, 5, 30)}) {
    paint_region(document(), box(stroke), right_, "Brush");
    EXPECT_TRUE(stroke.contains(exposed()));
    expect_what_all_together_would_show();
  }
  paint_region(document(), box({62, 12, 4, 4}), kBackground, "Brush");
  EXPECT_EQ(exposed(), QRect(62, 12, 4, 4));
  expect_what_all_together_would_show();
}

TEST_F(LiveViewTest, AFunctionExposesItsPixelsAlone) {
  ASSERT_NO_FATAL_FAILURE(begin());
  ramp(right_, 0.9);
  EXPECT_EQ(exposed(), kRight);
  expect_what_all_together_would_show();
  ramp(kBackground, 0.1);
  EXPECT_EQ(exposed(), QRect(0, 0, kWidth, kHeight));
  expect_what_all_together_would_show();
}

// One request is in flight and one waits: those between are never answered.
TEST_F(LiveViewTest, WhatWaitedInVainIsExposedWithTheNext) {
  ASSERT_NO_FATAL_FAILURE(begin());
  for (int step = 0; step < 40; ++step) {
    paint_region(document(), box({2 * step, step, 6, 5}), step % 2 == 0 ? right_ : kBackground, "Brush");
    if (step % 7 == 0) ramp(right_, 0.01 * step);
    if (step % 3 == 0) QCoreApplication::processEvents();
  }
  EXPECT_TRUE(answered());
  expect_what_all_together_would_show();
  document().end_drag();
  document().undo_stack().undo();
  EXPECT_TRUE(answered());
  EXPECT_EQ(difference(shown_, fresh_picture()), "");
}

TEST_F(LiveViewTest, AnythingElseExposesAllThatIsSeen) {
  ASSERT_NO_FATAL_FAILURE(begin());
  const QRect everything(0, 0, kWidth, kHeight);
  DocumentState brighter = document().state();
  brighter.brightness_ev = 0.5;
  document().apply(brighter, "Brighter");
  EXPECT_EQ(exposed(), everything);
  expect_what_all_together_would_show();
  const QRect seen(8, 2, 40, 40);
  live_.set_visible(seen, 1);
  ramp(right_, 0.9);
  EXPECT_EQ(exposed(), seen) << "what came into sight shows something older";
  ramp(right_, 0.8);
  EXPECT_EQ(exposed().size(), QSize(1, 1)) << "nothing that is seen changed";
  document().set_boxcar({10'000'000, 20'000'000}, "Scrub");
  EXPECT_EQ(exposed(), seen);
  ramp(right_, 0.7);
  EXPECT_EQ(exposed(), seen) << "from the interval back to functions";
}

// The picture has half as many pixels to a side as the capture, on a screen that shows no more.
TEST_F(LiveViewTest, WhatIsSeenSmallIsExposedSmall) {
  ASSERT_NO_FATAL_FAILURE(begin());
  document().end_drag();
  ASSERT_TRUE(answered());
  const QRect everything(0, 0, kWidth, kHeight);
  const auto reduced = session_of_part(*session_, {.scale = ClipScale{2}});
  live_.add_reduced(reduced, 2);
  std::vector<ShownPicture> pictures;
  QObject::connect(&live_, &LiveView::pictured,
                   [&](const ShownPicture& picture) { pictures.push_back(picture); });
  const auto exposed_now = [&] {
    pictures.clear();
    EXPECT_TRUE(answered());
    return pictures.empty() ? ShownPicture() : pictures.back();
  };
  document().begin_drag();
  live_.set_visible(everything, 1);
  ramp(right_, 0.9);
  EXPECT_EQ(exposed_now().divisor, 1) << "a screen that shows more";
  live_.set_visible(everything, 0.5);
  ramp(right_, 0.8);
  const ShownPicture whole = exposed_now();
  EXPECT_EQ(whole.divisor, 2);
  EXPECT_EQ(whole.place, everything);
  const DocumentState& state = document().state();
  Mask mask = Mask::uniform(kWidth / 2, kHeight / 2, 0);
  for (std::uint32_t y = 0; y < mask.height; ++y)
    for (std::uint32_t x = 0; x < mask.width; ++x)
      mask.tags[y * mask.width + x] = (*state.mask)->mask.tags[(2 * y + 1) * kWidth + 2 * x + 1];
  const auto wanted = reduced->render(exposure_of(state, Shared(MaskWithRegions(mask))), screen_format(),
                                      {.precision = Precision::single_});
  EXPECT_EQ(difference(whole.image, image_of(wanted.picture)), "");
  ramp(right_, 0.7);
  const ShownPicture part = exposed_now();
  EXPECT_EQ(part.place, kRight);
  EXPECT_EQ(part.image.size(), kRight.size() / 2);
  paint_region(document(), box({5, 7, 3, 2}), right_, "Brush");
  EXPECT_EQ(exposed_now().place, QRect(4, 6, 4, 4)) << "whole squares";
  document().end_drag();
  const ShownPicture full = exposed_now();
  EXPECT_TRUE(full.is_full);
  EXPECT_EQ(full.divisor, 1);
  EXPECT_EQ(difference(full.image, fresh_picture()), "");
}

TEST_F(LiveViewTest, ADragThatIsNotPromptIsExposedCoarser) {
  ASSERT_NO_FATAL_FAILURE(begin());
  document().end_drag();
  ASSERT_TRUE(answered());
  for (const int divisor : {2, 4})
    live_.add_reduced(session_of_part(*session_, {.scale = ClipScale{static_cast<std::uint32_t>(divisor)}}), divisor);
  int shown_divisor = 0;
  QObject::connect(&live_, &LiveView::pictured, [&](const ShownPicture& picture) { shown_divisor = picture.divisor; });
  const auto divisor_at = [&](double gain) {
    ramp(right_, gain);
    EXPECT_TRUE(answered());
    return shown_divisor;
  };
  for (const auto& [prompt_ms, screen_pixels, second] : {std::tuple(0.0, 0.5, 4), {1e9, 0.5, 2}, {0.0, 1.0, 2}}) {
    live_.set_prompt(prompt_ms);
    live_.set_visible({0, 0, kWidth, kHeight}, screen_pixels);
    document().begin_drag();
    EXPECT_EQ(divisor_at(0.9), screen_pixels < 1 ? 2 : 1);
    EXPECT_EQ(divisor_at(0.8), second) << prompt_ms << ", " << screen_pixels;
    document().end_drag();
    EXPECT_TRUE(answered());
    EXPECT_EQ(shown_divisor, 1);
  }
  EXPECT_EQ(difference(shown_, fresh_picture()), "");
}

TEST(ChangedPixels, AreThoseWithOtherTags) {
  const QRect everything(0, 0, kWidth, kHeight);
  const SharedMask none, left = mask_with({3, 4, 5, 6}, 7), both = mask_with({3, 4, 50, 6}, 7);
  EXPECT_EQ(changed_pixels(none, none, everything), QRect());
  EXPECT_EQ(changed_pixels(none, left, everything), everything);
  EXPECT_EQ(changed_pixels(left, left, everything), QRect());
  EXPECT_EQ(changed_pixels(left, both, everything), QRect(8, 4, 45, 6));
  EXPECT_EQ(changed_pixels(left, mask_with({3, 4, 5, 6}, 8), everything), QRect(3, 4, 5, 6));
  const SharedMask soft = Shared(MaskWithRegions(feathered((*left)->mask, Feather{300, {}})));
  EXPECT_EQ(changed_pixels(left, soft, everything), everything);
  TagBoxes boxes;
  EXPECT_EQ(boxes.of(left, 7, everything), QRect(3, 4, 5, 6));
  EXPECT_EQ(boxes.of(both, 7, everything), QRect(3, 4, 50, 6));
  EXPECT_EQ(boxes.of(both, 0, everything), everything);
  EXPECT_EQ(boxes.of(both, 9, everything), QRect());
  EXPECT_EQ(boxes.of(soft, 7, everything), everything);
}

}  // namespace
}  // namespace nutik::studio
