// A caller that changes its mind: the latest request wins, and what it gets is what it would have got of the session.
#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "session/live/live_pictures.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"
#include "support/scratch.hpp"
#include "support/tik_files.hpp"

namespace nutik::test {
namespace {

class LivePicturesTest : public ::testing::Test {
 protected:
  static Session session_of(const RandomCase& random, const Scratch& scratch) {
    SourceRequest source;
    source.path = write_tik(random, {tik::CodecId::zstd, 0}, scratch);
    ComputingRequest computing;
    computing.cache_folder = std::filesystem::temp_directory_path() / "nutik-test-kernels";
    return Session(source, computing);
  }

  // The k-th of many: each as bright as no other.
  [[nodiscard]] LiveRequest request(std::size_t k) {
    ExposureRequest exposure;
    exposure.gains = Shared(random_.functions);
    exposure.mask = Shared(MaskWithRegions(random_.mask));
    exposure.gain = 1.0 + 0.01 * static_cast<double>(k);
    const OutputFormat codes{ValueType::code16, 65'535, NegativeLight::offset};
    const Rectangle corner{1, 2, random_.capture.shape.width / 2, 5};
    return {{&session_, exposure, codes, corner},
            LivePart{&session_, exposure, codes, Rectangle::whole(random_.capture.shape)}};
  }

  [[nodiscard]] ExposedPicture alone(const LivePart& part, std::optional<Precision> precision) {
    return session_.render(part.exposure, part.output, {.rectangle = part.rectangle, .precision = precision});
  }

  RandomCase random_{33, {3, 1, 255, Transfer::srgb()}};
  Scratch scratch_;
  Session session_ = session_of(random_, scratch_);
};

// Answers as they come, and a gate that keeps the first one waiting.
class Answers {
 public:
  void operator()(LiveAnswer answer) {
    std::unique_lock lock(mutex_);
    answers_.push_back(std::move(answer));
    changed_.notify_all();
    changed_.wait(lock, [&] { return is_open_; });
  }
  void open() {
    const std::scoped_lock lock(mutex_);
    is_open_ = true;
    changed_.notify_all();
  }
  void wait_for_first() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !answers_.empty(); });
  }
  // Once nobody delivers any more.
  [[nodiscard]] const std::vector<LiveAnswer>& all() const { return answers_; }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<LiveAnswer> answers_;
  bool is_open_ = false;
};

TEST_F(LivePicturesTest, AnswersTheLatestRequestOnly) {
  Answers answers;
  LivePictures live([&](LiveAnswer answer) { answers(std::move(answer)); });
  EXPECT_EQ(live.ask(request(1)), 1u);
  answers.wait_for_first();  // it is in flight while the others are asked for
  for (std::size_t k = 2; k <= 6; ++k) EXPECT_EQ(live.ask(request(k)), k);
  answers.open();
  live.wait();
  const std::vector<LiveAnswer>& all = answers.all();
  ASSERT_EQ(all.size(), 3u);
  EXPECT_TRUE(all[0].request == 1 && all[0].is_preview);
  EXPECT_TRUE(all[1].request == 6 && all[1].is_preview);
  EXPECT_TRUE(all[2].request == 6 && !all[2].is_preview);
  ASSERT_GT(random_.capture.shape.height, kTileSide) << "it takes several strips";
  const LiveRequest last = request(6);
  const ExposedPicture preview = alone(last.preview, Precision::single_), full = alone(*last.full, {});
  EXPECT_EQ(all[1].rectangle, last.preview.rectangle);
  EXPECT_EQ(all[2].rectangle, last.full->rectangle);
  EXPECT_EQ(all[1].exposed->picture.bytes, preview.picture.bytes);
  EXPECT_EQ(all[1].exposed->precision, Precision::single_);
  EXPECT_EQ(all[2].exposed->picture.shape, full.picture.shape);
  EXPECT_EQ(all[2].exposed->picture.bytes, full.picture.bytes);
  EXPECT_EQ(all[2].exposed->saturation, full.saturation);
  EXPECT_EQ(all[2].exposed->precision, full.precision);
  EXPECT_EQ(all[2].exposed->warnings, full.warnings);
}

// Many of whose values are infinite, which each strip has some of.
TEST_F(LivePicturesTest, AFullPictureIsThatOfTheSession) {
  for (const bool maps_bounds : {false, true}) {
    LiveRequest asked = request(1);
    asked.full->output = {ValueType::light32, 0};
    asked.full->output.maps_bounds = maps_bounds;
    asked.full->exposure.gain = 1e39;
    std::optional<ExposedPicture> found;
    LivePictures live([&](LiveAnswer answer) { found = std::move(answer.exposed); });
    live.ask(asked);
    live.wait();
    const ExposedPicture full = alone(*asked.full, {});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->picture, full.picture);
    EXPECT_FALSE(full.warnings.empty());
    EXPECT_EQ(found->warnings, full.warnings);
    ASSERT_EQ(found->bounds.size(), full.bounds.size());
    EXPECT_NE(full.bounds.empty(), maps_bounds);
    for (std::size_t i = 0; i < full.bounds.size(); ++i) EXPECT_EQ(found->bounds[i].values, full.bounds[i].values) << i;
  }
}

TEST_F(LivePicturesTest, PartsAddUpWhatTheyTook) {
  Rendered part;
  part.saturation = {1, 2};
  part.statistics = {.read_ms = 3, .payload_bytes = 4, .device_bytes = 5, .blocks = 6, .launches = 7};
  part.warnings = {"a", "b"};
  for (const bool is_made_beside : {false, true}) {
    Rendered whole = part;
    whole.warnings = {"b"};
    add_part(whole, part, is_made_beside);
    EXPECT_EQ(whole.saturation, (Saturation{2, 4}));
    EXPECT_EQ(whole.warnings, (std::vector<std::string>{"b", "a"}));
    EXPECT_EQ(whole.statistics.read_ms, is_made_beside ? 3 : 6);
    EXPECT_EQ(whole.statistics.payload_bytes, is_made_beside ? 4u : 8u);
    EXPECT_EQ(whole.statistics.device_bytes, is_made_beside ? 10u : 5u);
    EXPECT_EQ(whole.statistics.blocks, 6u);
    EXPECT_EQ(whole.statistics.launches, 14u);
  }
}

// Whatever is asked while a full picture is on its way: previews come first, and what is old is given up.
TEST_F(LivePicturesTest, GivesUpFullPicturesThatNobodyWaitsFor) {
  std::vector<LiveAnswer> answers;
  LivePictures* asked = nullptr;
  LivePictures live([&](LiveAnswer answer) {
    answers.push_back(std::move(answer));
    if (answers.size() < 5) asked->ask(request(answers.size() + 1));
  });
  asked = &live;
  live.ask(request(1));
  live.wait();
  ASSERT_EQ(answers.size(), 6u);
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_EQ(answers[k].request, k + 1);
    EXPECT_TRUE(answers[k].is_preview) << k;
  }
  EXPECT_EQ(answers[5].request, 5u);
  EXPECT_FALSE(answers[5].is_preview);
}

TEST_F(LivePicturesTest, DeliversWhatWentWrongAndGoesOn) {
  std::vector<LiveAnswer> answers;
  LivePictures live([&](LiveAnswer answer) { answers.push_back(std::move(answer)); });
  LiveRequest wrong = request(1);
  wrong.preview.rectangle.x = random_.capture.shape.width;
  live.ask(wrong);
  live.wait();
  LiveRequest wrong_later = request(2);
  wrong_later.full->rectangle.height += 1;
  live.ask(wrong_later);
  live.wait();
  live.ask(request(3));
  live.wait();
  ASSERT_EQ(answers.size(), 5u);
  for (const std::size_t k : {0u, 2u}) {
    EXPECT_FALSE(answers[k].exposed) << k;
    EXPECT_NE(message_of<UsageError>([&] { std::rethrow_exception(answers[k].error); }), "") << k;
  }
  EXPECT_TRUE(answers[1].is_preview && answers[1].exposed);
  EXPECT_FALSE(answers[2].is_preview);
  EXPECT_TRUE(answers[4].exposed && !answers[4].is_preview);
}

// Four threads that ask as fast as they can: nothing comes that is older than what came before, and the last request is
// answered. Then the pictures end in the middle of it.
TEST_F(LivePicturesTest, ComeInOrderWhoeverAsks) {
  std::vector<LiveAnswer> answers;
  std::atomic<bool> has_ended = false;
  const LiveRequest asked = request(1);
  {
    LivePictures live([&](LiveAnswer answer) {
      EXPECT_FALSE(has_ended);
      answers.push_back(std::move(answer));
    });
    const auto ask_often = [&] {
      for (std::size_t k = 0; k < 50; ++k) {
        live.ask(asked);
        std::this_thread::yield();
      }
    };
    {
      std::vector<std::jthread> threads;
      for (int t = 0; t < 4; ++t) threads.emplace_back(ask_often);
    }
    live.wait();
    ASSERT_GE(answers.size(), 2u);
    EXPECT_EQ(answers.back().request, 200u);
    EXPECT_FALSE(answers.back().is_preview);
    for (std::size_t k = 1; k < answers.size(); ++k) {
      const LiveAnswer &before = answers[k - 1], &answer = answers[k];
      EXPECT_TRUE(before.request < answer.request ||
                  (before.request == answer.request && before.is_preview && !answer.is_preview))
          << k;
    }
    for (int k = 0; k < 20; ++k) live.ask(asked);
  }
  has_ended = true;
}

}  // namespace
}  // namespace nutik::test
