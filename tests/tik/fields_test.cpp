// The list of fields: what it holds, what may be passed over, and damage.
#include "tik/fields.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "capture/error.hpp"
#include "support/messages.hpp"
#include "support/random_case.hpp"
#include "support/scratch.hpp"
#include "support/tik_files.hpp"
#include "system/checksum.hpp"
#include "tik/block_headers.hpp"
#include "tik/header.hpp"
#include "tik/reader.hpp"
#include "tik/writer.hpp"

namespace nutik::tik {
namespace {

using test::Scratch;

TEST(TikFields, AreReadAsTheyWereWritten) {
  for (const std::vector<Field>& fields :
       {std::vector<Field>{},
        {{"one ", false, ""}},
        {{"abcd", true, "1"}, {"efgh", false, std::string("12\0345678", 9)}}}) {
    std::vector<std::byte> bytes = packed_fields(fields);
    EXPECT_EQ(bytes.size() % 8, 0u);
    bytes.resize(bytes.size() + 100);  // what follows in a file
    const ReadFields read = read_fields(bytes, "x.tik");
    EXPECT_EQ(read.fields, fields);
    EXPECT_EQ(read.bytes + 100, bytes.size());
  }
}

TEST(TikFields, AreRefusedWhereABitDiffersOrTheEndIsMissing) {
  const std::vector<std::byte> bytes = packed_fields(std::vector<Field>{{"abcd", true, "some data"}});
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    std::vector<std::byte> damaged = bytes;
    damaged[bit / 8] ^= std::byte{1} << bit % 8;
    EXPECT_THROW(static_cast<void>(read_fields(damaged, "x.tik")), InputError) << bit;
  }
  test::expect_error<InputError>([&] { return read_fields(std::vector<std::byte>(bytes.size()), "x.tik"); },
                                 {"there is no list of fields"});
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_THROW(static_cast<void>(read_fields(std::span(bytes).first(size), "x.tik")), InputError) << size;
  }
}

// A list may be whole and lie: checksums keep nobody from that.
TEST(TikFields, AreRefusedWhereAFieldLeavesTheList) {
  std::vector<std::byte> bytes = packed_fields(std::vector<Field>{{"abcd", false, "12345678"}});
  const auto seal = [&] {
    const std::uint64_t sum = checksum(std::span(bytes).first(bytes.size() - 8));
    std::memcpy(bytes.data() + bytes.size() - 8, &sum, 8);
  };
  for (const std::uint64_t length : {std::uint64_t{9}, ~std::uint64_t{0}}) {
    std::memcpy(bytes.data() + 32, &length, 8);
    seal();
    EXPECT_THROW(static_cast<void>(read_fields(bytes, "x.tik")), InputError);
  }
  const std::uint64_t eight = 8;
  std::memcpy(bytes.data() + 32, &eight, 8);
  const std::uint32_t two = 2;
  std::memcpy(bytes.data() + 16, &two, 4);
  seal();
  EXPECT_THROW(static_cast<void>(read_fields(bytes, "x.tik")), InputError);
}

TEST(TikFields, OfACaptureSayHowItIsShown) {
  test::RandomCase random(5);
  random.capture.pixel_aspect = {32, 27};
  random.capture.primaries = Primaries::bt2020;
  random.capture.transfer = Transfer::hlg();
  const Scratch scratch;
  Header header;
  header.capture = random.capture;
  if (random.timeline.is_constant()) header.rate = random.timeline.rate();
  header.shutter_angle = random.timeline.shutter_angle();
  header.facts = {"240 pictures a second, from the file's com.android.capture.fps", "matrix bt2020, assumed"};
  EXPECT_EQ(header.fields().size(), 4u);
  const auto path = test::write_tik(random, {CodecId::zstd, 0}, scratch);
  Reader reader(path);
  EXPECT_EQ(reader.header().version, 1u);
  EXPECT_EQ(reader.format().pixel_aspect, (Rational{32, 27}));
  EXPECT_EQ(reader.format().primaries, Primaries::bt2020);
  EXPECT_EQ(reader.format().transfer, Transfer::hlg());
  test::expect_same_capture(random, reader);
}

// A file with these fields behind its picture.
std::string file_with(const std::vector<Field>& fields) {
  std::string text =
      "P5\n# TIK 1 - later\n# TIK depth: 8 bits\n# TIK white code: 255\n# TIK rate: 30 samples a second\n"
      "# TIK shutter angle: 360 degrees\n# TIK transfer: srgb\n# TIK tolerance: 0 codes\n# TIK codec: none\n"
      "1 1\n255\nx\n";
  text.resize((text.size() + 63) / 64 * 64);
  const std::vector<std::byte> list = packed_fields(fields);
  text.append(reinterpret_cast<const char*>(list.data()), list.size());
  text.resize((text.size() + 63) / 64 * 64);
  return text;
}

TEST(TikFields, SayHowPicturesWereMovedOntoEachOther) {
  Header header;
  header.alignment = Alignment{"homography", 12, true, 17.99, 1.0 / 3, 2e-9};
  const std::string file = file_with(header.fields());
  const auto parse = [](const std::string& bytes) {
    return parse_header(std::as_bytes(std::span(bytes)), "x.tik").header.alignment;
  };
  EXPECT_EQ(parse(file), header.alignment);
  EXPECT_EQ(parse(file_with({})), std::nullopt);
  EXPECT_THROW(static_cast<void>(parse(file_with({{"algn", false, "rigid -1 cut 0 0 0"}}))), InputError);
  EXPECT_THROW(static_cast<void>(parse(file_with({{"algn", false, "rigid 1 cut 0"}}))), InputError);
}

TEST(TikFields, SayWhichPicturesOfAClipAreHeld) {
  Header header;
  header.part = PartOfClip{2, 20'000'000, 6, "a b.mov", "xxh3-64:1"};
  const auto parse = [](const std::string& bytes) {
    return parse_header(std::as_bytes(std::span(bytes)), "x.tik").header.part;
  };
  EXPECT_EQ(parse(file_with(header.fields())), header.part);
  EXPECT_EQ(parse(file_with({})), std::nullopt);
  EXPECT_EQ(parse(file_with({{"clip", false, "xxh3-64:1"}})), std::nullopt);
  // So large that no sum with a capture's own is too large.
  EXPECT_EQ(parse(file_with({{"part", false, "4611686018427387903 4611686018427387903 0 "}})),
            (PartOfClip{(std::uint64_t{1} << 62) - 1, (std::int64_t{1} << 62) - 1, 0, ""}));
  for (const char* damaged : {"", "2", "2 3", "-2 3 6 a", "2 -3 6 a", "2 3 x a", "4611686018427387904 0 0 a",
                              "0 4611686018427387904 0 a", "99999999999999999999 0 0 a"}) {
    EXPECT_THROW(static_cast<void>(parse(file_with({{"part", false, damaged}}))), InputError) << damaged;
  }
}

TEST(TikFields, SayThatPicturesWereScaled) {
  const auto parse = [](const std::string& bytes) {
    return parse_header(std::as_bytes(std::span(bytes)), "x.tik").header.is_scaled;
  };
  Header header;
  header.is_scaled = true;
  EXPECT_TRUE(parse(file_with(header.fields())));
  EXPECT_FALSE(parse(file_with({})));
}

// Earlier programs did not.
TEST(TikFields, SayHowCodesWereMade) {
  const auto parse = [](const std::vector<Field>& fields) {
    const std::string file = file_with(fields);
    return parse_header(std::as_bytes(std::span(file)), "x.tik").header.roundings;
  };
  Header header;
  EXPECT_EQ(parse(header.fields()), CodeRoundings{});
  header.roundings.add(0.0, 1.0, "fields");
  EXPECT_EQ(parse(header.fields()), header.roundings);
  EXPECT_FALSE(parse({}).are_known());
  EXPECT_FALSE(parse({{"rond", false, "1"}}).are_known());
}

// Earlier programs kept of a picture's times what made samples left.
TEST(TikFields, SayWhenPicturesWereFilmed) {
  const MadeSamples made{{1, 2, 0}};
  for (const Timeline& filmed : {Timeline::constant({30'000, 1001}, Timeline::kFullShutter, 3),
                                 Timeline::irregular({0, 500, 2000}, Timeline::kFullShutter)}) {
    const Timeline all = made.times(filmed);
    const auto read = [&](const Header& header, std::uint64_t samples) {
      const std::string file = file_with(header.fields());
      const std::vector<Exposure> exposures(all.table().begin(), all.table().begin() + static_cast<int>(samples));
      Header parsed = parse_header(std::as_bytes(std::span(file)), "x.tik").header;
      parsed.rate.reset();  // the file's text has one
      return timeline_of(parsed, samples, exposures, {}, "x.tik");
    };
    Header header;
    header.made = made;
    EXPECT_EQ(read(header, 6).pictures().start_ns(1), all.start_ns(2));
    header.filmed = filmed_times(filmed);
    const Timeline whole = read(header, 6).pictures(), cut = read(header, 4).pictures();
    EXPECT_EQ(whole.sample_count(), 3u);
    EXPECT_EQ(cut.sample_count(), 2u);
    EXPECT_EQ(whole.is_constant(), filmed.is_constant());
    for (const std::uint64_t k : {0, 1}) {
      EXPECT_EQ(whole.times(k).start_ns, filmed.start_ns(k));
      EXPECT_EQ(cut.end_ns(k), filmed.end_ns(k));
    }
    EXPECT_EQ(whole.end_ns(2), filmed.end_ns(2));
    header.filmed = std::vector<Exposure>{{0, 10}};
    test::expect_error<InputError>([&] { return read(header, 6); }, {"not every picture has one"});
  }
}

TEST(TikFields, OfLaterProgramsArePassedOverUnlessTheyMustNotBe) {
  const auto parse = [](const std::string& file) {
    return parse_header(std::as_bytes(std::span(file)), "x.tik");
  };
  const std::string passed = file_with({{"late", false, "whatever"}, {"fact", false, "one\ntwo\n"}});
  const ParsedHeader parsed = parse(passed);
  EXPECT_EQ(parsed.header.facts, (std::vector<std::string>{"one", "two"}));
  EXPECT_EQ(parsed.first_block_offset, passed.size());
  const std::string message = test::message_of<InputError>([&] { return parse(file_with({{"late", true, ""}})); });
  EXPECT_NE(message.find("'late'"), std::string::npos) << message;
  EXPECT_NE(message.find("a later one"), std::string::npos) << message;
  EXPECT_THROW(static_cast<void>(parse(file_with({{"prim", true, "bt1886"}}))), InputError);
  EXPECT_THROW(static_cast<void>(parse(file_with({{"aspc", false, std::string(8, '\0')}}))), InputError);
}

}  // namespace
}  // namespace nutik::tik
