// Recordings of Photron's cameras: every layout of values that a header can name gives its codes back, and what a
// header does not say, or cannot mean, is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <span>

#include "capture/error.hpp"
#include "media/clip.hpp"
#include "media/input_checksum.hpp"
#include "support/clips.hpp"
#include "support/messages.hpp"
#include "support/scratch.hpp"
#include "support/stills.hpp"

namespace nutik::test {
namespace {

constexpr Shape kPhotronGrey{8, 5, 1}, kPhotronColour{4, 5, 3};

// The values as digits, as the format's description has them, and those as bytes.
std::string packed(const std::vector<Picture>& pictures, int bits) {
  std::string digits;
  for (const Picture& picture : pictures) {
    for (std::size_t i = 0; i < picture.shape.value_count(); ++i) {
      for (int bit = bits - 1; bit >= 0; --bit) digits += (code_of(picture, i) >> bit & 1) != 0 ? '1' : '0';
    }
  }
  std::string bytes;
  for (std::size_t at = 0; at < digits.size(); at += 8) {
    bytes += static_cast<char>(std::stoi(digits.substr(at, 8), nullptr, 2));
  }
  return bytes;
}

std::string words(const std::vector<Picture>& pictures, std::uint32_t shift) {
  std::string bytes;
  for (const Picture& picture : pictures) {
    for (std::size_t i = 0; i < picture.shape.value_count(); ++i) {
      const std::uint32_t value = code_of(picture, i) << shift;
      bytes += {static_cast<char>(value & 255), static_cast<char>(value >> 8)};
    }
  }
  return bytes;
}

struct Header {
  Shape shape = kPhotronGrey;
  std::string colour = "Mono";
  int pixel_bits = 16, depth = 16;
  std::string side = "Lower";
  std::string count = "3";
  std::string more = {};

  // As the camera's program writes it, with line ends of its own.
  [[nodiscard]] std::string text() const {
    return "#Camera Information Header\r\nCamera Type : FASTCAM Mini\r\nRecord Rate(fps) : 4000\r\n"
           "Shutter Speed(s) : 1/8000\r\nOriginal Total Frame : 1000\r\nTotal Frame : " +
           count + "\r\nImage Width : " + std::to_string(shape.width) +
           "\r\nImage Height : " + std::to_string(shape.height) + "\r\nColor Type : " + colour +
           "\r\nColor Bit : " + std::to_string(pixel_bits) +
           "\r\nFile Format : MRaw\r\nEffectiveBit Depth : " + std::to_string(depth) +
           "\r\nEffectiveBit Side : " + side + "\r\n" + more + "END\r\n";
  }
  [[nodiscard]] std::string xml() const {
    const std::string size = "<resolution><width>" + std::to_string(shape.width) + "</width><height>" +
                             std::to_string(shape.height) + "</height></resolution>";
    return "!!!\nCIHX\n<?xml version=\"1.0\"?>\n<cih><imageFileInfo><fileFormat>Mraw</fileFormat><resolution>"
           "<width>1</width></resolution></imageFileInfo>\n<imageDataInfo>" +
           size + "<colorInfo><type>" + colour + "</type><bit>" + std::to_string(pixel_bits) +
           "</bit></colorInfo><effectiveBit><depth>" + std::to_string(depth) + "</depth><side>" + side +
           "</side></effectiveBit></imageDataInfo><frameInfo><recordedFrame>9</recordedFrame><totalFrame>" +
           count +
           "</totalFrame></frameInfo><recordInfo><recordRate>4000</recordRate><shutterSpeedNsec>125000"
           "</shutterSpeedNsec></recordInfo></cih>";
  }
};

TEST(PhotronClip, GivesTheCodesOfEveryLayoutBack) {
  struct Case {
    const char* name;
    Header header;
    std::uint32_t white;
  };
  const Case cases[] = {
      {"8 bits", {kPhotronGrey, "Mono", 8, 8}, 255},
      {"12 packed", {kPhotronGrey, "Mono", 12, 12}, 4095},
      {"10 packed, raw", {kPhotronGrey, "Raw", 10, 10}, 1023},
      {"16 bits", {kPhotronGrey, "Mono", 16, 16}, 65'535},
      {"12 of 16, lower", {kPhotronGrey, "Mono", 16, 12}, 4095},
      {"12 of 16, upper", {kPhotronGrey, "Mono", 16, 12, "Higher"}, 4095},
      {"8 of 16, upper", {kPhotronGrey, "Mono", 16, 8, "Higher"}, 255},
      {"8 of 16, lower", {kPhotronGrey, "Mono", 16, 8}, 255},
      {"colour of 8 bits", {kPhotronColour, "Color", 24, 8}, 255},
      {"colour of 12 packed", {kPhotronColour, "Color", 36, 12}, 4095},
      {"colour of 16 bits", {kPhotronColour, "Color", 48, 16}, 65'535},
  };
  for (const Case& tested : cases) {
    for (const bool is_xml : {false, true}) {
      SCOPED_TRACE(std::string(tested.name) + (is_xml ? ", .cihx" : ", .cih"));
      const Header& header = tested.header;
      const Scratch scratch;
      const auto stills = random_stills(header.shape, tested.white, 3, tested.white);
      const int bits = header.pixel_bits / static_cast<int>(header.shape.channels);
      const std::uint32_t shift =
          header.side == "Higher" ? static_cast<std::uint32_t>(bits - header.depth) : 0;
      const auto pictures =
          scratch.write("ball.mraw", bits == 16 ? words(stills, shift) : packed(stills, bits));
      const auto beside =
          scratch.write(is_xml ? "ball.cihx" : "ball.cih", is_xml ? header.xml() : header.text());
      for (const auto& name : {pictures, beside}) {
        const auto clip = open_test_clip(name);
        EXPECT_EQ(clip->info().format.shape, header.shape);
        EXPECT_EQ(clip->info().format.white_code, tested.white);
        EXPECT_EQ(clip->info().format.transfer, Transfer::linear());
        EXPECT_EQ(clip->info().timing.rate_from, beside.filename());
        EXPECT_TRUE(clip->info().notes.empty());
        const Timeline timeline = timeline_of("", clip->info(), {}, 3);
        EXPECT_EQ(timeline.rate(), (Rational{4000, 1}));
        EXPECT_EQ(timeline.shutter_angle(), (Rational{180, 1}));
        const auto rasters = read_all(*clip);
        ASSERT_EQ(rasters.size(), 3u);
        for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(difference(rasters[k], stills[k]), "") << k;
      }
    }
  }
}

// Pixels may begin as any file does.
TEST(PhotronClip, IsOneByItsNameWhateverItsPixelsAre) {
  for (const std::string start : {"% ", "P5\n", "\xFF\xD8\xFF", "\xFF\x0A", "BM", "adder", "\x1F\x8B"}) {
    const Scratch scratch;
    auto stills = random_stills(kPhotronGrey, 255, 1, 7);
    std::ranges::copy(std::as_bytes(std::span(start)), stills[0].bytes.begin());
    const auto pictures = scratch.write("ball.mraw", packed(stills, 8));
    scratch.write("ball.cih", Header{kPhotronGrey, "Mono", 8, 8, "Lower", "1"}.text());
    EXPECT_EQ(difference(read_all(*open_test_clip(pictures)).at(0), stills[0]), "") << start;
  }
}

// With the right number of bytes for its header, unless another size is asked for.
std::string refusal(const Header& header, std::size_t bytes = 8 * 5 * 2 * 3) {
  const Scratch scratch;
  const auto pictures = scratch.write("ball.mraw", std::string(bytes, '\1'));
  scratch.write("ball.cih", header.text());
  return message_of<InputError>([&] { read_all(*open_test_clip(pictures)); });
}

void expect_refusal(const std::string& part, const Header& header, std::size_t bytes = 8 * 5 * 2 * 3) {
  const std::string message = refusal(header, bytes);
  expect_says(message, part);
}

TEST(PhotronClip, SaysWhatItsHeaderDoesNotFit) {
  expect_refusal(
      "ball.mraw was cut off: ball.cih names 3 pictures (8 x 5 pixels of 16 bits), and it has 2 whole "
      "ones, which can be taken",
      {}, 8 * 5 * 2 * 3 - 1);
  expect_refusal("ball.mraw has 241 bytes, and ball.cih names 3 pictures, 80 bytes each", {}, 241);
  expect_refusal("does not say how large", {{0, 5, 1}});
  expect_refusal("does not say how large", {{70'000, 5, 1}});
  expect_refusal("its pixels have 0 bits", {kPhotronGrey, "Mono", 0, 0});
  expect_refusal("its pixels have 7 bits", {kPhotronGrey, "Mono", 7, 7});
  expect_refusal("its pixels have 32 bits", {kPhotronGrey, "Mono", 32, 16});
  expect_refusal("its pixels have 16 bits in 3 channels", {kPhotronGrey, "Color", 16, 8});
  expect_refusal("pictures of the type 'indexed' are not read", {kPhotronGrey, "Indexed"});
  expect_refusal("mosaic of a colour sensor", {kPhotronGrey, "Bayer"});
  expect_refusal("12 bits at the side 'higher' of values of 12 bits", {kPhotronGrey, "Mono", 12, 12, "Higher"});
  expect_refusal("10 bits at the side 'lower' of values of 12 bits", {kPhotronGrey, "Mono", 12, 10});
  expect_refusal("a picture is no whole number of bytes", {{3, 5, 1}, "Mono", 12, 12});
  expect_refusal("17 bits at the side 'lower' of values of 16 bits", {kPhotronGrey, "Mono", 16, 17});
  expect_refusal("at the side 'middle'", {kPhotronGrey, "Mono", 16, 12, "Middle"});
  // Every value is 0x0101.
  expect_refusal("picture 0 has the value 257, and ball.cih says that only the 12 upper of 16 bits count",
                 {kPhotronGrey, "Mono", 16, 12, "Higher"});
  expect_refusal("picture 0 has the value 257, and ball.cih says that 8 bits count", {kPhotronGrey, "Mono", 16, 8});
}

TEST(PhotronClip, IsTakenAsFarAsItGoes) {
  const Scratch scratch;
  const auto stills = random_stills(kPhotronGrey, 65'535, 3, 1);
  const std::string whole = words(stills, 0);
  scratch.write("ball.mraw", whole.substr(0, whole.size() - 1));
  scratch.write("ball.cih", Header{}.text());
  const ClipOptions options{.ends_at_damage = true};
  const auto clip = open_test_clip(scratch / "ball.mraw", options);
  const auto rasters = read_all(*clip);
  ASSERT_EQ(rasters.size(), 2u);
  EXPECT_EQ(difference(rasters[1], stills[1]), "");
  ASSERT_TRUE(clip->ended_early());
  EXPECT_NE(clip->ended_early()->find("is taken as far as it goes, 2 of 3 pictures: "), std::string::npos);

  // Pictures that are passed over end where those do that are read.
  const auto passed = open_test_clip(scratch / "ball.mraw", options);
  std::vector<std::byte> room(passed->info().format.sample_bytes());
  for (int picture = 0; picture < 2; ++picture) EXPECT_TRUE(passed->skip(room));
  EXPECT_FALSE(passed->skip(room));
  EXPECT_TRUE(passed->ended_early());
}

TEST(PhotronClip, OfAColourSensorIsRefusedWhereItIsAMosaic) {
  const Scratch scratch;
  scratch.write("ball.mraw", std::string(8 * 5 * 2 * 3, '\1'));
  Header header{kPhotronGrey, "Raw"};
  std::string xml = header.xml();
  xml.replace(xml.find("</cih>"), 6,
              "<deviceInfo><deviceName>FASTCAM Nova S16 type 1100K-C-64GB</deviceName></deviceInfo></cih>");
  scratch.write("ball.cihx", xml);
  expect_error<InputError>([&] { open_test_clip(scratch / "ball.mraw"); }, {"mosaic of a colour sensor"});
}

TEST(PhotronClip, NamesTheFilesThatAreMissing) {
  const Scratch scratch;
  const auto pictures = scratch.write("ball.mraw", std::string(8 * 5 * 2 * 3, '\1'));
  const auto message = [&](const std::filesystem::path& path) {
    return message_of<InputError>([&] { open_test_clip(path); });
  };
  expect_says(message(pictures), "ball.cih or ball.cihx beside it");
  const auto text = scratch.write("ball.cih", Header{}.text());
  scratch.write("ball.cihx", Header{}.xml());
  expect_says(message(pictures), "two headers lie beside it");
  EXPECT_EQ(open_test_clip(text)->info().sample_count, 3u);
  std::filesystem::remove(pictures);
  expect_says(message(text), "its pictures, ball.mraw, do not lie beside it");
}

TEST(PhotronClip, CountsSavedPicturesAndSaysSo) {
  const Scratch scratch;
  scratch.write("ball.mraw", std::string(8 * 5 * 2 * 3, '\1'));
  Header header;
  header.more = "Save Step : 4\r\n";
  scratch.write("ball.cih", header.text());
  const auto clip = open_test_clip(scratch / "ball.mraw");
  EXPECT_EQ(clip->info().timing.rate, (Rational{1000, 1}));
  ASSERT_EQ(clip->info().notes.size(), 1u);
  expect_says(clip->info().notes[0].text, "one of 4 pictures was saved");
}

// A recipe knows a recording by its pictures and by what says how they are read.
TEST(PhotronClip, ItsChecksumIsThatOfBothFiles) {
  const Scratch scratch;
  const auto checksums = [&](const std::string& header) {
    scratch.write("ball.cih", header);
    return std::vector{input_checksum(scratch.write("ball.mraw", std::string(8 * 5 * 2 * 3, '\1'))),
                       input_checksum(scratch.write("ball.yuv", "raw"), true), input_checksum(scratch.folder()),
                       input_checksum(scratch / "*.pgm"), input_checksum(scratch / "ball.yuv")};
  };
  scratch.write("0.pgm", "P5 1 1 255 x");
  const auto before = checksums(Header{}.text()), after = checksums(Header{kPhotronGrey, "Mono", 16, 12}.text());
  EXPECT_EQ(input_checksum(scratch / "ball.cih"), after[0]);
  // The last two are read without it.
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(before[i] == after[i], i > 2) << i;
}

// The shared recording, which its owner converted to PNG, too.
TEST(PhotronClip, ARecordingIsWhatItsPngsAre) {
  const std::filesystem::path media = NUTIK_TEST_MEDIA;
  if (!std::filesystem::exists(media / "ball_12bit.mraw")) GTEST_SKIP() << "no clips in " << media;
  const auto recording = open_test_clip(media / "ball_12bit.mraw");
  const auto pngs = open_test_clip(media / "ball_12bit_png", {.white_code = 4095});
  EXPECT_EQ(recording->info().format, pngs->info().format);
  EXPECT_EQ(timeline_of("", recording->info(), {}, 15).rate(), (Rational{30'000, 1}));
  const auto got = read_all(*recording), wanted = read_all(*pngs);
  ASSERT_EQ(got.size(), 15u);
  EXPECT_TRUE(got == wanted);
}

}  // namespace
}  // namespace nutik::test
