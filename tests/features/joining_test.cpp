// Parts of a clip that were encoded by themselves and joined are the capture that was encoded in one go.
#include "features/captures/joining.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "features/captures/retiming.hpp"
#include "imev/sample_cursor.hpp"
#include "session/clips/encoding.hpp"
#include "support/clips.hpp"
#include "support/messages.hpp"
#include "support/still_clip.hpp"
#include "support/tik_files.hpp"
#include "tik/reader.hpp"

namespace nutik::test {
namespace {

using Path = std::filesystem::path;

// What a capture holds at every sample.
Rasters samples_of(const Path& path) {
  tik::Reader reader(path);
  Rasters samples;
  for (std::uint64_t block = 0; block < reader.block_count(); ++block) {
    const BlockLease lease = reader.acquire(block);
    const BlockView view(reader.format(), lease.extent(), lease.payload());
    SampleCursor cursor(reader.format().shape, view);
    for (std::uint32_t k = 0; k < lease.extent().sample_count; ++k) {
      cursor.go_to(k);
      cursor.read(samples.emplace_back(reader.format().sample_bytes()));
    }
  }
  return samples;
}

// 26 stills of 20 x 20 pixels in `frames`.
class Joining : public testing::Test {
 protected:
  static constexpr std::uint32_t kSide = 20, kStills = 26, kBlock = 4;

  void SetUp() override {
    use_modules();
    write_still_clip(scratch_.folder(), kSide, kStills);
    whole_.path = scratch_ / "frames";
    whole_.clip.rate = Rational{100, 1};
    whole_.block_samples = kBlock;
  }

  // Pictures [first, end) of the clip.
  Path part(std::uint64_t first, std::uint64_t end, SourceRequest source) const {
    source.clip.from = ClipMoment{static_cast<std::int64_t>(first), true};
    source.clip.to = ClipMoment{static_cast<std::int64_t>(end), true};
    return encoded("part" + std::to_string(first) + "-" + std::to_string(end) + ".tik", source);
  }
  Path part(std::uint64_t first, std::uint64_t end) const { return part(first, end, whole_); }
  Path encoded(const std::string& name, const SourceRequest& source) const {
    static_cast<void>(encode(source, {scratch_ / name, codec_}, MemoryBudget::of_machine()));
    return scratch_ / name;
  }
  // The clip, cut at these pictures and joined.
  Joined join_at(const std::vector<std::uint64_t>& cuts, const SourceRequest& source) const {
    JoinRequest request{{}, scratch_ / "joined.tik"};
    std::uint64_t first = 0;
    for (const std::uint64_t cut : cuts) {
      request.captures.push_back(part(first, cut, source));
      first = cut;
    }
    request.captures.push_back(part(first, kStills, source));
    std::swap(request.captures.front(), request.captures.back());  // whatever order they are named in
    return join(request);
  }
  std::string refusal(const std::vector<Path>& captures) const {
    const std::string message = message_of<InputError>([&] { return join({captures, scratch_ / "refused.tik"}); });
    EXPECT_FALSE(std::filesystem::exists(scratch_ / "refused.tik"));
    return message;
  }
  // A table of the stills; its column of exposures is left out where they are 0.
  Path table(bool has_exposures) const {
    std::string text;
    std::int64_t start_ns = 1'000;
    for (std::uint32_t k = 0; k < kStills; ++k) {
      std::string name = std::to_string(k);
      name.insert(0, 3 - name.size(), '0');
      text += "frames/" + name + ".pgm," + std::to_string(start_ns) + "," +
              (has_exposures ? std::to_string(3'000 + 100 * k) : "") + "\n";
      start_ns += 10'000 + 1'000 * (k * k % 7);
    }
    return scratch_.write("table.csv", text);
  }

  // A copy of a capture whose header says something else.
  Path saying(const Path& path, const std::function<void(tik::Header&)>& change) const {
    return write_saying(tik::Reader(path), scratch_ / "saying.tik", change);
  }

  Scratch scratch_;
  SourceRequest whole_;
  tik::Codec codec_{tik::CodecId::rice, 0};
};

// Block for block, and the timeline.
void expect_same_capture(const Path& got, const Path& wanted) {
  const tik::Reader a(got), b(wanted);
  EXPECT_EQ(a.format(), b.format());
  EXPECT_EQ(a.timeline(), b.timeline());
  EXPECT_EQ(a.header().rate, b.header().rate);
  EXPECT_EQ(a.header().codec, b.header().codec);
  EXPECT_TRUE(std::ranges::equal(a.first_sample(), b.first_sample()));
  ASSERT_EQ(a.block_count(), b.block_count());
  for (std::uint64_t block = 0; block < a.block_count(); ++block) {
    const auto of_a = a.stored(block), of_b = b.stored(block);
    EXPECT_EQ(of_a.header.first_sample, of_b.header.first_sample);
    EXPECT_EQ(of_a.header.sample_count, of_b.header.sample_count);
    EXPECT_EQ(of_a.header.record_count, of_b.header.record_count);
    EXPECT_EQ(of_a.header.codec, of_b.header.codec);
    EXPECT_EQ(of_a.header.exposures_checksum, of_b.header.exposures_checksum);
    EXPECT_TRUE(std::ranges::equal(of_a.payload, of_b.payload));
  }
}

TEST_F(Joining, OfWholeBlocksIsTheCaptureInOneGo) {
  for (const char* codec : {"rice", "none", "lz4", "zstd:3"}) {
    SCOPED_TRACE(codec);
    codec_ = tik::Codec::parse(codec);
    const Path one = encoded("whole.tik", whole_);
    const Joined joined = join_at({8, 12, 24}, whole_);
    expect_same_capture(scratch_ / "joined.tik", one);
    EXPECT_EQ(joined.file_bytes, std::filesystem::file_size(scratch_ / "joined.tik"));
    ASSERT_EQ(joined.parts.size(), 4u);
    EXPECT_EQ(joined.parts[1].first_sample, 8u);
    EXPECT_EQ(joined.parts[1].sample_count, 4u);
    EXPECT_TRUE(joined.notes.empty());
    EXPECT_EQ(joined.facts.back(), "joined of 4 captures, part0-8.tik … part24-26.tik");
    EXPECT_EQ(std::ranges::count(joined.facts, "pictures 0 … 25 of 26, as stated"), 1);
    // Captures that are written with one angle, too.
    SourceRequest half = whole_;
    half.shutter_angle = Rational{180, 1};
    const Path open_half = encoded("half.tik", half);
    static_cast<void>(join_at({4}, half));
    expect_same_capture(scratch_ / "joined.tik", open_half);
  }
}

// Blocks begin where parts do; what they hold is the same.
TEST_F(Joining, OfAnyPartsHoldsTheSameSamples) {
  const Path one = encoded("whole.tik", whole_);
  const Rasters wanted = samples_of(one);
  for (const std::vector<std::uint64_t>& cuts :
       {std::vector<std::uint64_t>{1}, {25}, {1, 2, 3, 5}, {7, 13, 14}, {6, 11, 21}}) {
    const Joined joined = join_at(cuts, whole_);
    EXPECT_EQ(joined.timeline, tik::Reader(one).timeline());
    EXPECT_TRUE(samples_of(scratch_ / "joined.tik") == wanted);
  }
}

// A part starts from its own codes, so it holds others than the clip in one go; of none is further from the clip's.
TEST_F(Joining, OfATolerantEncodingStaysWithinTheTolerance) {
  const Rasters clip = samples_of(encoded("exact.tik", whole_));
  SourceRequest tolerant = whole_;
  tolerant.tolerance = 9;
  const Rasters in_one_go = samples_of(encoded("whole.tik", tolerant));
  static_cast<void>(join_at({8, 13}, tolerant));
  const Rasters joined = samples_of(scratch_ / "joined.tik");
  ASSERT_EQ(joined.size(), clip.size());
  int largest = 0;
  for (std::size_t k = 0; k < clip.size(); ++k) {
    for (std::size_t i = 0; i < clip[k].size(); ++i) {
      largest =
          std::max(largest, std::abs(std::to_integer<int>(joined[k][i]) - std::to_integer<int>(clip[k][i])));
    }
  }
  EXPECT_LE(largest, 9);
  EXPECT_GT(largest, 0);
  EXPECT_FALSE(joined == in_one_go);
  // Up to the first seam, where a new segment begins, they are the same; there the codes are the clip's own.
  EXPECT_TRUE(std::ranges::equal(std::span(joined).first(8), std::span(in_one_go).first(8)));
  EXPECT_TRUE(joined[8] == clip[8]);
  EXPECT_EQ(tik::Reader(scratch_ / "joined.tik").format().noise.tolerance, 9u);
}

TEST_F(Joining, OfNoisyPicturesIsTheCaptureInOneGoWhereBlocksAreWhole) {
  CameraNoise noise;
  noise.channels.push_back({NoiseCurve::points, 0, 0, {{10, 3, 100}, {200, 5, 100}}});
  SourceRequest noisy = whole_;
  noisy.noise = StatedNoise{"camera.noise", noise};
  const Path one = encoded("whole.tik", noisy);
  static_cast<void>(join_at({12, 20}, noisy));
  expect_same_capture(scratch_ / "joined.tik", one);
  // Means are those of a block's samples: others where a part ends within one, but no further from the clip's.
  static_cast<void>(join_at({11}, noisy));
  const Rasters clip = samples_of(encoded("exact.tik", whole_)), joined = samples_of(scratch_ / "joined.tik");
  ASSERT_EQ(joined.size(), clip.size());
  const tik::Reader reader(scratch_ / "joined.tik");
  const double scale = reader.format().white_code / 255.0;
  for (std::size_t k = 0; k < clip.size(); ++k) {
    for (std::size_t i = 0; i < clip[k].size(); ++i) {
      const double held = reinterpret_cast<const std::uint16_t*>(joined[k].data())[i] / scale;
      // The held code is rounded to half a code of 16 bits; the deviation is the larger of those that noise has.
      ASSERT_LE(std::abs(held - std::to_integer<int>(clip[k][i])), noisy.sigmas * 5.0 + 0.5 / scale);
    }
  }
}

TEST_F(Joining, KeepsIrregularTimes) {
  for (const bool has_exposures : {false, true}) {
    for (const auto& angle : {std::optional<Rational>(), std::optional(Rational{90, 1})}) {
      if (has_exposures && angle) continue;
      SCOPED_TRACE(has_exposures);
      SourceRequest listed = whole_;
      listed.path = table(has_exposures);
      listed.clip.rate.reset();
      listed.shutter_angle = angle;
      const Path one = encoded("whole.tik", listed);
      ASSERT_FALSE(tik::Reader(one).timeline().is_constant());
      for (const std::vector<std::uint64_t>& cuts : {std::vector<std::uint64_t>{1}, {25}, {8, 9, 10, 17}}) {
        const Joined joined = join_at(cuts, listed);
        EXPECT_EQ(joined.timeline, tik::Reader(one).timeline());
        EXPECT_EQ(joined.facts[0], tik::Reader(one).header().facts[0]);
        EXPECT_EQ(joined.facts[1], tik::Reader(one).header().facts[1]);
      }
      static_cast<void>(join_at({4, 16}, listed));
      expect_same_capture(scratch_ / "joined.tik", one);
    }
  }
}

TEST_F(Joining, OfAHundredParts) {
  std::filesystem::create_directory(scratch_ / "many");
  write_still_clip(scratch_ / "many", kSide, 100);
  SourceRequest many = whole_;
  many.path = scratch_ / "many/frames";
  many.block_samples = 1;
  JoinRequest request{{}, scratch_ / "joined.tik"};
  for (std::uint64_t k = 100; k-- > 0;) request.captures.push_back(part(k, k + 1, many));
  const Joined joined = join(request);
  EXPECT_EQ(joined.parts.size(), 100u);
  expect_same_capture(scratch_ / "joined.tik", encoded("whole.tik", many));
}

TEST_F(Joining, IsJoinedAgain) {
  const Path a = part(0, 4), b = part(4, 8), c = part(8, 9), d = part(9, kStills);
  static_cast<void>(join({{a, b}, scratch_ / "ab.tik"}));
  static_cast<void>(join({{d, c}, scratch_ / "cd.tik"}));
  const Joined joined = join({{scratch_ / "cd.tik", scratch_ / "ab.tik"}, scratch_ / "joined.tik"});
  EXPECT_TRUE(samples_of(scratch_ / "joined.tik") == samples_of(encoded("whole.tik", whole_)));
  EXPECT_EQ(joined.facts.back(), "joined of 2 captures, ab.tik … cd.tik");
  EXPECT_EQ(std::ranges::count(joined.facts, "pictures 0 … 25 of 26, as stated"), 1);
  // And parts that are not the clip's first.
  const Joined late = join({{c, d}, scratch_ / "late.tik"});
  EXPECT_EQ(std::ranges::count(late.facts,
                               "pictures 8 … 25 of 26, whose time 0 is 0.08 s after the clip's, as stated"),
            1);
  ASSERT_EQ(late.notes.size(), 1u);
  EXPECT_EQ(late.notes[0].text, "pictures 0 … 7 of frames are in none of the captures");
  const Joined middle = join({{b, c}, scratch_ / "middle.tik"});
  ASSERT_EQ(middle.notes.size(), 2u);
  EXPECT_EQ(middle.notes[1].text, "pictures 9 … 25 of frames are in none of the captures");
}

TEST_F(Joining, FollowsWhatRetimeCorrected) {
  for (const auto& [first, end] : {std::pair(0, 8), std::pair(8, 26)}) {
    const Path path = part(static_cast<std::uint64_t>(first), static_cast<std::uint64_t>(end));
    static_cast<void>(retime({path, path, Rational{50, 1}, Rational{90, 1}, {}, {}, {}}));
    const auto held = tik::Reader(path).header().part;
    ASSERT_TRUE(held);
    EXPECT_EQ(held->start_ns, first * 20'000'000);
  }
  const Joined joined =
      join({{scratch_ / "part0-8.tik", scratch_ / "part8-26.tik"}, scratch_ / "joined.tik"});
  EXPECT_EQ(joined.timeline, Timeline::constant({50, 1}, {90, 1}, kStills));
  expect_says(tik::Reader(scratch_ / "part8-26.tik").header().facts[0], "50 pictures a second, as stated");
}

TEST_F(Joining, FollowsAnotherAngleOfIrregularTimes) {
  SourceRequest irregular = whole_;
  irregular.path = table(false);
  irregular.clip.rate.reset();
  const std::vector<Path> paths{encoded("whole.tik", irregular), part(0, 7, irregular),
                                part(7, 25, irregular), part(25, kStills, irregular)};
  for (const Path& path : paths) static_cast<void>(retime({path, path, {}, Rational{90, 1}, {}, {}, {}}));
  const Joined joined = join({{paths[1], paths[2], paths[3]}, scratch_ / "joined.tik"});
  EXPECT_EQ(joined.timeline, tik::Reader(paths[0]).timeline());
  EXPECT_EQ(joined.timeline.shutter_angle(), (Rational{90, 1}));
}

// Captures of two clips, as where a camera begins a new file.
TEST_F(Joining, TakesCapturesThatSayNothingAsTheyAreNamed) {
  const Path a = encoded("a.tik", whole_), b = encoded("b.tik", whole_);
  const Joined joined = join({{a, b}, scratch_ / "joined.tik"});
  EXPECT_EQ(joined.timeline, Timeline::constant({100, 1}, {360, 1}, 2 * kStills));
  ASSERT_EQ(joined.notes.size(), 1u);
  expect_says(joined.notes[0].text, "they are taken to follow each other at once");
  EXPECT_FALSE(tik::Reader(scratch_ / "joined.tik").header().part);
  expect_says(refusal({a, part(0, 4)}), "a.tik does not; encode that as a part, too");
  SourceRequest irregular = whole_;
  irregular.path = table(false);
  irregular.clip.rate.reset();
  const Path c = encoded("c.tik", irregular);
  expect_says(refusal({c, c}), "nothing says how long after its pictures");
}

TEST_F(Joining, RefusesWhatDoesNotFollow) {
  const Path a = part(0, 8), b = part(8, 12), c = part(11, 20), d = part(20, kStills);
  EXPECT_EQ(message_of<UsageError>([&] { return join({{a}, scratch_ / "x.tik"}); }), "two captures or more are joined");
  const std::string folder = scratch_.folder().string() + "/";
  EXPECT_EQ(refusal({a, d, b}), "pictures 12 … 19 of frames are missing between " + folder +
                                    "part8-12.tik and " + folder +
                                    "part20-26.tik; encode them, and join all parts");
  expect_says(refusal({part(0, 7), b}), "picture 7 of frames are missing");
  EXPECT_EQ(refusal({a, b, c}),
            folder + "part8-12.tik and " + folder +
                "part11-20.tik both hold picture 11 of frames; leave one out, or encode it without "
                "them");
  expect_says(refusal({a, a}), "both hold pictures 0 … 7 of frames");
  std::filesystem::create_directory(scratch_ / "other");
  std::filesystem::copy(scratch_ / "frames", scratch_ / "other/night");
  SourceRequest night = whole_;
  night.path = scratch_ / "other/night";
  expect_says(refusal({a, part(8, 20, night)}), "part0-8.tik is a part of frames, and ");
  std::filesystem::rename(scratch_ / "other/night", scratch_ / "other/frames");
  night.path = scratch_ / "other/frames";
  const Path copied = part(8, 20, night);
  static_cast<void>(join({{a, copied}, scratch_ / "joined.tik"}));
  // A clip of the same name, but with other pictures, which captures of earlier programs do not tell.
  std::filesystem::copy(scratch_ / "frames/000.pgm", night.path / "025.pgm",
                        std::filesystem::copy_options::overwrite_existing);
  expect_says(refusal({a, part(8, 20, night)}), "parts of two clips named frames, whose content differs");
  const Path silent = saying(copied, [](tik::Header& header) { header.part->checksum.clear(); });
  const std::vector<Note> notes = join({{a, silent}, scratch_ / "joined.tik"}).notes;
  ASSERT_FALSE(notes.empty());
  expect_says(notes.back().text,
              "saying.tik does not tell its clip's content: whether its frames is the clip of the others is not known");
  EXPECT_EQ(tik::Reader(scratch_ / "joined.tik").header().part->checksum, "");
  const Path middle = saying(part(8, 12), [](tik::Header& header) { header.part->checksum.clear(); });
  expect_says(refusal({a, middle, part(12, 20, night)}),
              "part0-8.tik and " + folder + "part12-20.tik are parts of two");
  // Or with fewer.
  std::filesystem::remove(night.path / "025.pgm");
  expect_says(refusal({a, part(8, 20, night)}), "is a part of a clip frames with 26 pictures, and ");
}

TEST_F(Joining, IsOffByWhatTheWorstPartIs) {
  const Path worse = saying(part(8, 12), [](tik::Header& header) { header.roundings.add(2.0, 1.0, kUnknown); });
  static_cast<void>(join({{part(0, 8), worse, part(12, 20)}, scratch_ / "joined.tik"}));
  const CodeRoundings roundings = tik::Reader(scratch_ / "joined.tik").header().roundings;
  EXPECT_NEAR(roundings.codes, 2.0, 1e-5);
  EXPECT_FALSE(roundings.are_known());
  static_cast<void>(join({{part(0, 8), part(8, 12)}, scratch_ / "joined.tik"}));
  EXPECT_TRUE(tik::Reader(scratch_ / "joined.tik").header().roundings.are_known());
}

TEST_F(Joining, RefusesTimesThatOverlap) {
  SourceRequest irregular = whole_;
  irregular.path = table(false);
  irregular.clip.rate.reset();
  const Path a = part(0, 8, irregular), b = part(8, 12, irregular);
  const Path early = saying(b, [](tik::Header& header) { header.part->start_ns -= 1; });
  expect_says(refusal({a, early}), "whose last exposure ends later; encode both with the same rate and shutter angle");
  // Later than it is would be a gap in time, which irregular times may have.
  const Path late = saying(b, [](tik::Header& header) { header.part->start_ns += 5; });
  const Joined joined = join({{a, late}, scratch_ / "joined.tik"});
  EXPECT_EQ(joined.timeline.start_ns(8), joined.timeline.end_ns(7) + 5);
}

TEST_F(Joining, RefusesWhatWasEncodedOtherwise) {
  const Path a = part(0, 8);
  const auto expect = [&](const std::string& wanted, auto change) {
    SourceRequest other = whole_;
    change(other);
    const std::string message = refusal({a, part(8, 12, other)});
    expect_says(message, wanted);
  };
  expect("pictures of 20 x 20 grey, and ", [](SourceRequest& r) { r.clip.crop = Rectangle{0, 0, 10, 20}; });
  expect("codes of 8 bits with white 255, and ", [](SourceRequest& r) { r.clip.white_code = 254; });
  expect("transfer srgb, and ", [](SourceRequest& r) { r.clip.transfer = Transfer::linear(); });
  expect("pixels 1:1, and ", [](SourceRequest& r) { r.clip.pixel_aspect = Rational{4, 3}; });
  expect("100 pictures a second, and ", [](SourceRequest& r) { r.clip.rate = Rational{100'001, 1000}; });
  expect("shutter 360 degrees, and ", [](SourceRequest& r) { r.shutter_angle = Rational{180, 1}; });
  expect("a tolerance of 0 codes, and ", [](SourceRequest& r) { r.tolerance = 1; });
  expect("the clip's own pixels, and ", [](SourceRequest& r) { r.clip.scale = ClipScale{1}; });
  // The same size, but elsewhere.
  const auto cut = [](std::uint32_t x) {
    return [x](SourceRequest& r) { r.clip.crop = Rectangle{x, 0, 8, 8}; };
  };
  SourceRequest left = whole_, right = whole_;
  cut(0)(left);
  cut(4)(right);
  expect_says(refusal({part(0, 8, left), part(8, 12, right)}), "was taken for '8 x 8 from 0,0 of 20 x 20', and ");
}

TEST_F(Joining, RefusesWhatWasMeasuredOnEachPart) {
  CameraNoise noise;
  noise.channels.push_back({NoiseCurve::points, 0, 0, {{10, 3, 100}, {200, 5, 100}}});
  SourceRequest one = whole_, other = whole_;
  one.noise = StatedNoise{"a.noise", noise};
  noise.channels[0].points[0].sd = 2;
  other.noise = StatedNoise{"b.noise", noise};
  expect_says(refusal({part(0, 8, one), part(8, 12, other)}), "measure it once, and encode all parts");
  SourceRequest even = whole_;
  even.deflickered = true;
  expect_says(refusal({part(0, 8, even), part(8, 12, even)}), "is exposed as its own first picture");
  // Aligned captures say so in their header.
  const Path aligned = saying(part(8, 12), [](tik::Header& header) {
    header.alignment = tik::Alignment{"rigid", 0, false, 1, 0, 0.1};
  });
  expect_says(refusal({part(0, 8), aligned}), "was aligned onto a picture of its own");
}

TEST_F(Joining, LeavesNothingWhereAPartIsDamaged) {
  const Path a = part(0, 8), b = part(8, 12);
  std::string bytes = read_file(b);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  scratch_.write("part8-12.tik", bytes);
  expect_says(refusal({a, b}), "part8-12.tik: ");
}

TEST_F(Joining, JoinsBlocksOfAllCodecs) {
  codec_ = tik::Codec::parse("none");
  const Path a = part(0, 8);
  codec_ = tik::Codec::parse("rice");
  const Path b = part(8, kStills);
  static_cast<void>(join({{a, b}, scratch_ / "joined.tik"}));
  // The field that tells older programs of such blocks.
  EXPECT_EQ(tik::Reader(scratch_ / "joined.tik").header().codec, "rice");
  EXPECT_TRUE(samples_of(scratch_ / "joined.tik") == samples_of(encoded("whole.tik", whole_)));
}

}  // namespace
}  // namespace nutik::test
