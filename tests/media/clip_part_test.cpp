// Parts of clips: which pictures, which pixels, and means of light against the definition, in extended precision.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "capture/error.hpp"
#include "support/clips.hpp"
#include "support/ffmpeg.hpp"
#include "support/messages.hpp"
#include "support/scratch.hpp"
#include "support/stills.hpp"

namespace nutik::test {
namespace {

// A folder of stills that state their white code.
void write_stills(const Scratch& scratch, const std::vector<Picture>& stills) {
  for (std::size_t k = 0; k < stills.size(); ++k) {
    scratch.write("f" + std::to_string(k) + (stills[k].shape.channels == 1 ? ".pgm" : ".ppm"),
                  netpbm_file(stills[k], false));
  }
}

// A TIFF with a smaller copy behind each page.
std::string with_copies(const std::vector<Picture>& stills) {
  std::vector<Picture> pages;
  for (const Picture& still : stills) {
    pages.push_back(still);
    pages.push_back(random_stills({5, 3, 1}, still.white_code, 1, 2).front());
  }
  std::string file = tiff_file(pages, {.tags = {{254, {4, 1, 0}}}});
  // NewSubfileType, the first entry of a directory, is 1 of each second one.
  const auto number_at = [&](std::size_t at) {
    std::uint32_t number = 0;
    std::memcpy(&number, file.data() + at, sizeof number);
    return number;
  };
  constexpr std::size_t kEntry = 12;
  std::size_t at = number_at(4);
  for (int page = 0; at != 0; ++page) {
    file[at + 2 + 8] = static_cast<char>(page % 2);
    at = number_at(at + 2 + kEntry * static_cast<unsigned char>(file[at]));
  }
  return file;
}

std::uint32_t code_of(std::span<const std::byte> raster, bool is_wide, std::size_t index) {
  if (!is_wide) return std::to_integer<std::uint32_t>(raster[index]);
  return reinterpret_cast<const std::uint16_t*>(raster.data())[index];
}

TEST(ClipPart, CutsARectangleOut) {
  for (const Shape& shape : {Shape{17, 9, 1}, Shape{17, 9, 3}}) {
    for (const std::uint32_t white : {255u, 4095u}) {
      const Scratch scratch;
      const auto stills = random_stills(shape, white, 2, white);
      write_stills(scratch, stills);
      for (const Rectangle& crop : {Rectangle{0, 0, 17, 9}, Rectangle{3, 2, 5, 7}, Rectangle{16, 8, 1, 1}}) {
        const auto clip = open_test_clip(scratch.folder(), {.rate = Rational{100, 1}, .crop = crop});
        EXPECT_EQ(clip->info().format.shape, (Shape{crop.width, crop.height, shape.channels}));
        EXPECT_EQ(clip->info().format.white_code, white);
        const auto rasters = read_all(*clip);
        ASSERT_EQ(rasters.size(), 2u);
        for (std::size_t k = 0; k < 2; ++k) {
          for (std::uint32_t y = 0; y < crop.height; ++y) {
            for (std::uint32_t i = 0; i < crop.width * shape.channels; ++i) {
              const std::size_t from = ((crop.y + y) * shape.width + crop.x) * shape.channels + i;
              ASSERT_EQ(code_of(rasters[k], white > 255, y * crop.width * shape.channels + i),
                        code_of(stills[k].bytes, white > 255, from));
            }
          }
        }
      }
    }
  }
}

// IEC 61966-2-1, and powers; exact to some 1e-18.
long double light_of(const Transfer& transfer, long double c) {
  if (transfer.is_linear()) return c;
  if (transfer == Transfer::gamma(2.2)) return std::pow(c, 2.2L);
  return c <= 0.04045L ? c / 12.92L : std::pow((c + 0.055L) / 1.055L, 2.4L);
}

// The share of [a, a + 1] in [begin, end].
long double overlap(long double a, long double begin, long double end) {
  return std::max(0.0L, std::min(a + 1, end) - std::max(a, begin));
}

// The mean of the light of `area` that new pixel x, y of `scaled` covers.
long double mean_light(const Picture& still, const Transfer& transfer, const Rectangle& area,
                       const Shape& scaled, std::uint32_t x, std::uint32_t y, std::uint32_t channel) {
  const long double wide = static_cast<long double>(area.width) / scaled.width,
                    high = static_cast<long double>(area.height) / scaled.height;
  long double sum = 0;
  for (std::uint32_t v = 0; v < area.height; ++v) {
    for (std::uint32_t u = 0; u < area.width; ++u) {
      const long double share = overlap(u, x * wide, (x + 1) * wide) * overlap(v, y * high, (y + 1) * high);
      const std::size_t index =
          ((area.y + v) * still.shape.width + area.x + u) * still.shape.channels + channel;
      const bool is_wide = still.type == ValueType::code16;
      if (share > 0) {
        sum += share * light_of(transfer, static_cast<long double>(code_of(still.bytes, is_wide, index)) /
                                              still.white_code);
      }
    }
  }
  return sum / (wide * high);
}

TEST(ClipPart, ScalesToMeansOfLight) {
  struct Case {
    const char* scale;
    Rectangle area;  // what new pixels cover
    Shape scaled;
    Rational aspect;
  };
  const Rectangle crop{1, 2, 15, 7};
  const Case cases[] = {
      {"1/2", {1, 2, 14, 6}, {7, 3, 0}, {1, 1}},     {"1/3", {1, 2, 15, 6}, {5, 2, 0}, {1, 1}},
      {"1/1", {1, 2, 15, 7}, {15, 7, 0}, {1, 1}},    {"5x7", {1, 2, 15, 7}, {5, 7, 0}, {3, 1}},
      {"11x4", {1, 2, 15, 7}, {11, 4, 0}, {60, 77}}, {"1x1", {1, 2, 15, 7}, {1, 1, 0}, {15, 7}}};
  int worst_border = 0;
  for (const std::uint32_t channels : {1u, 3u}) {
    for (const std::uint32_t white : {255u, 1023u, 65'535u}) {
      for (const Transfer& transfer : {Transfer::srgb(), Transfer::linear(), Transfer::gamma(2.2)}) {
        const Scratch scratch;
        const auto stills = random_stills({17, 9, channels}, white, 1, white + channels);
        write_stills(scratch, stills);
        for (const Case& tested : cases) {
          SCOPED_TRACE(std::string(tested.scale) + ", white " + std::to_string(white) + ", " +
                       transfer.text());
          const auto clip = open_test_clip(scratch.folder(), {.rate = Rational{100, 1},
                                                              .transfer = transfer,
                                                              .crop = crop,
                                                              .scale = parse_scale(tested.scale)});
          Shape scaled = tested.scaled;
          scaled.channels = channels;
          ASSERT_EQ(clip->info().format.shape, scaled);
          EXPECT_EQ(clip->info().format.pixel_aspect, tested.aspect);
          const auto raster = read_all(*clip).at(0);
          for (std::uint32_t i = 0; i < scaled.value_count(); ++i) {
            const std::uint32_t pixel = i / channels;
            const long double light = mean_light(stills[0], transfer, tested.area, scaled,
                                                 pixel % scaled.width, pixel / scaled.width, i % channels);
            const long double code = code_of(raster, white > 255, i);
            // It rounds to this code, but for what double precision cannot tell at a border.
            const long double lower = code == 0 ? -1 : light_of(transfer, (code - 0.5L) / white),
                              upper = code == white ? 2 : light_of(transfer, (code + 0.5L) / white);
            EXPECT_GE(light, lower - 1e-14L);
            EXPECT_LT(light, upper + 1e-14L);
            worst_border += light < lower || light >= upper;
          }
        }
      }
    }
  }
  std::cout << worst_border << " means lay within double precision of a border\n";
}

// What does not change within a pixel keeps its code, whatever the function.
TEST(ClipPart, KeepsTheCodesOfEvenAreas) {
  for (const std::uint32_t white : {255u, 65'535u}) {
    for (const Transfer& transfer : {Transfer::srgb(), Transfer::bt709(), Transfer::hlg(), Transfer::pq()}) {
      const Scratch scratch;
      Picture still({64, 12, 1}, white == 255 ? ValueType::code8 : ValueType::code16, white);
      for (std::size_t i = 0; i < still.shape.pixel_count(); ++i) {
        const std::size_t block = i / 64 / 3 * 16 + i % 64 / 4;  // of 4 x 3 pixels
        const auto code = block * white / 63;
        if (white == 255) still.values<std::uint8_t>()[i] = static_cast<std::uint8_t>(code);
        if (white > 255) still.values<std::uint16_t>()[i] = static_cast<std::uint16_t>(code);
      }
      write_stills(scratch, {still});
      const ClipOptions options{.rate = Rational{100, 1}, .transfer = transfer, .scale = parse_scale("16x4")};
      const auto raster = read_all(*open_test_clip(scratch.folder(), options)).at(0);
      for (std::size_t block = 0; block < 64; ++block) {
        EXPECT_EQ(code_of(raster, white > 255, block), block * white / 63) << transfer.text();
      }
    }
  }
}

// Pictures that start from the one moment on and before the other. At 30 a second the starts are 0, 33333333,
// 66666667, 100000000, 133333333, 166666667 ns.
TEST(ClipPart, TakesThePicturesBetweenTwoMoments) {
  const Scratch scratch;
  const auto stills = random_stills({4, 3, 1}, 255, 6, 1);
  write_stills(scratch, stills);
  struct Case {
    std::optional<ClipMoment> from, to;
    std::size_t first, end;
  };
  const Case cases[] = {{ClipMoment{2, true}, {}, 2, 6},
                        {{}, ClipMoment{4, true}, 0, 4},
                        {ClipMoment{1, true}, ClipMoment{6, true}, 1, 6},
                        {ClipMoment{66'666'667, false}, {}, 2, 6},
                        {ClipMoment{66'666'668, false}, {}, 3, 6},
                        {ClipMoment{66'666'666, false}, ClipMoment{166'666'667, false}, 2, 5},
                        {ClipMoment{0, false}, ClipMoment{166'666'668, false}, 0, 6},
                        {ClipMoment{0, false}, ClipMoment{9'000'000'000, false}, 0, 6}};
  for (const Case& tested : cases) {
    const auto clip =
        open_test_clip(scratch.folder(), {.rate = Rational{30, 1}, .from = tested.from, .to = tested.to});
    EXPECT_EQ(clip->info().sample_count, tested.end - tested.first);
    const auto rasters = read_all(*clip);
    ASSERT_EQ(rasters.size(), tested.end - tested.first);
    for (std::size_t k = 0; k < rasters.size(); ++k) {
      EXPECT_EQ(difference(rasters[k], stills[tested.first + k]), "");
    }
  }
}

TEST(ClipPart, KeepsWhenItsPicturesWereExposed) {
  const Scratch scratch;
  write_stills(scratch, random_stills({4, 3, 1}, 255, 4, 1));
  const auto table = scratch.write("t.csv", "f0.pgm,0,5\nf1.pgm,10,7\nf2.pgm,30,20\nf3.pgm,70,1\n");
  const ClipOptions options{.from = ClipMoment{5, false}, .to = ClipMoment{70, false}};
  const auto clip = open_test_clip(table, options);
  const Timeline timeline = timeline_of("", clip->info(), options, read_all(*clip).size());
  // Time 0 is the start of the first that is taken.
  ASSERT_EQ(timeline.sample_count(), 2u);
  EXPECT_EQ(timeline.start_ns(0), 0);
  EXPECT_EQ(timeline.end_ns(0), 7);
  EXPECT_EQ(timeline.start_ns(1), 20);
  EXPECT_EQ(timeline.end_ns(1), 40);
  ASSERT_FALSE(clip->info().facts.empty());
  EXPECT_EQ(clip->info().facts.back().text, "pictures 1 … 2 of 4, whose time 0 is 1e-08 s after the clip's");
}

// A part's last picture holds until the clip's next one; the clip's last as long as the one before it.
TEST(ClipPart, HoldsItsPicturesAsLongAsTheClip) {
  const Scratch scratch;
  write_stills(scratch, random_stills({4, 3, 1}, 255, 4, 1));
  const auto table = scratch.write("t.csv", "f0.pgm,0,\nf1.pgm,10,\nf2.pgm,30,\nf3.pgm,70,\n");
  const std::int64_t starts[] = {0, 10, 30, 70, 110};
  for (std::uint64_t first = 0; first < 4; ++first) {
    for (std::uint64_t end = first + 1; end <= 4; ++end) {
      const ClipOptions options{.from = ClipMoment{static_cast<std::int64_t>(first), true},
                                .to = ClipMoment{static_cast<std::int64_t>(end), true}};
      const auto clip = open_test_clip(table, options);
      EXPECT_EQ(clip->info().part, (PartOfClip{first, starts[first], 4, "t.csv"}));
      const Timeline timeline = timeline_of("", clip->info(), options, {180, 1}, end - first);
      ASSERT_EQ(timeline.sample_count(), end - first);
      EXPECT_EQ(timeline.duration_ns(), starts[end] - starts[first]);
      for (std::uint64_t k = first; k < end; ++k) {
        EXPECT_EQ(timeline.start_ns(k - first), starts[k] - starts[first]);
        EXPECT_EQ(timeline.end_ns(k - first), (starts[k] + starts[k + 1]) / 2 - starts[first]);
      }
    }
  }
}

// Pictures before a part are not decoded where no others are made of them.
TEST(ClipPart, OfAVideoHasTheSamePictures) {
  NEEDS_FFMPEG();
  const Scratch scratch;
  for (const char* coding :
       {"-c:v mjpeg -pix_fmt yuvj420p a.avi", "-c:v prores a.mov", "-c:v rawvideo -pix_fmt yuv420p a.avi",
        "-pix_fmt yuv420p a.y4m", "-c:v huffyuv a.mkv", "-c:v ffv1 a.mkv", "-c:v mpeg4 -bf 2 a.mp4",
        "-c:v mjpeg -pix_fmt yuvj420p -ss 0.1 a.mov"}) {
    SCOPED_TRACE(coding);
    test::make(scratch, std::string("-f lavfi -i testsrc2=size=32x24:rate=25 -frames:v 9 ") + coding);
    const std::string name = std::string(coding).substr(std::string(coding).rfind(' ') + 1);
    const auto whole = read_all(*open_test_clip(scratch / name));
    for (std::size_t first = 0; first < whole.size(); first += 3) {
      const auto part =
          read_all(*open_test_clip(scratch / name, {.from = ClipMoment{static_cast<std::int64_t>(first), true},
                                                    .to = ClipMoment{static_cast<std::int64_t>(first + 2), true}}));
      ASSERT_EQ(part.size(), std::min<std::size_t>(2, whole.size() - first));
      for (std::size_t k = 0; k < part.size(); ++k) EXPECT_TRUE(part[k] == whole[first + k]) << first + k;
    }
  }
}

// Pages before a part are passed over: in one directory, in one each, among copies that are no moments, and in files.
TEST(ClipPart, OfAStackHasTheSamePictures) {
  const auto stills = random_stills({17, 9, 1}, 65'535, 6, 1);
  const auto half = [&](std::size_t first) {
    return tiff_file({stills.begin() + static_cast<std::ptrdiff_t>(first), stills.begin() + first + 3}, {});
  };
  for (const std::string kind : {"in one", "pages", "copies", "files"}) {
    SCOPED_TRACE(kind);
    const Scratch scratch;
    if (kind == "files") {
      for (const std::size_t first : {0u, 3u}) scratch.write(first == 0 ? "a.tif" : "b.tif", half(first));
    } else {
      scratch.write("a.tif", kind == "pages" ? tiff_file(stills, {})
                             : kind == "in one"
                                 ? tiff_file(stills, {.description = "ImageJ=1.53t\nimages=6\n", .in_one = true})
                                 : with_copies(stills));
    }
    for (std::int64_t first = 0; first < 6; ++first) {
      for (std::int64_t end = first + 1; end <= 6; ++end) {
        const auto clip = open_test_clip(scratch.folder(), {.rate = Rational{100, 1},
                                                            .from = ClipMoment{first, true},
                                                            .to = ClipMoment{end, true}});
        expect_codes(*clip, {stills.begin() + first, stills.begin() + end});
      }
    }
  }
}

TEST(ClipPart, IsRefusedWhereTheClipHasNone) {
  const Scratch scratch;
  write_stills(scratch, random_stills({17, 9, 1}, 255, 4, 1));
  const auto options = [](ClipOptions of) {
    of.rate = Rational{100, 1};
    return of;
  };
  const auto picture = [](std::int64_t number) { return ClipMoment{number, true}; };
  for (const auto& [wish, part] : {
           std::pair(options({.crop = Rectangle{10, 2, 8, 3}}),
                     "8 x 3 pixels from 10,2 on do not lie in the pictures of"),
           {options({.scale = ClipScale{10}}), "1 x 0 pixels cannot be made of 17 x 9"},
           {options({.scale = ClipScale{0, 18, 9}}), "18 x 9 pixels cannot be made of 17 x 9"},
           {options({.from = picture(4)}), "which has 4 pictures (0f … 3f, the last from 0.03 s on)"},
           {options({.from = ClipMoment{30'000'001, false}}), "no picture begins that late"},
           {options({.to = picture(5)}), "picture 5 is not in"},
           {options({.from = picture(2), .to = picture(2)}), "no picture begins between the two"},
           {options({.from = picture(3), .to = picture(2)}), "the part ends before it begins in"},
           {options({.from = ClipMoment{-1, false}}), "begins at its start or later"},
           // Times need a rate, pictures do not.
           {ClipOptions{.from = ClipMoment{1, false}}, "does not say how fast it was taken"},
           // No mean can be told of a code that stands for no light.
           {options({.white_code = 100, .scale = ClipScale{2}}), "and white is 100"},
       }) {
    SCOPED_TRACE(part);
    expect_error<Error>([&, &wish = wish] { read_all(*open_test_clip(scratch.folder(), wish)); }, {part});
  }
  EXPECT_NO_THROW(read_all(*open_test_clip(scratch.folder(), {.from = picture(1)})));
}

TEST(ClipPart, IsStatedInWords) {
  EXPECT_EQ(parse_crop("640x360+100+50"), (Rectangle{100, 50, 640, 360}));
  EXPECT_EQ(parse_scale("1/3"), (ClipScale{3}));
  EXPECT_EQ(parse_scale("640x360"), (ClipScale{0, 640, 360}));
  for (const char* text :
       {"", "640x360", "640x360+1", "0x3+1+1", "4x4+1+1+1", "-4x4+1+1", "4x4-1-1", "99999999999x1+0+0"}) {
    EXPECT_NE(message_of<UsageError>([&] { return parse_crop(text); }).find("640x360+100+50"), std::string::npos)
        << text;
  }
  for (const char* text : {"", "2", "1/0", "2/3", "0.5", "640", "640x", "x360", "0x4", "1/2x"}) {
    EXPECT_NE(message_of<UsageError>([&] { return parse_scale(text); }).find("write 1/2, 1/3"), std::string::npos)
        << text;
  }
}

}  // namespace
}  // namespace nutik::test
