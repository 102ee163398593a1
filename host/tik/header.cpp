#include "tik/header.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <map>
#include <string_view>

#include "capture/capture_mark.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/noise_file.hpp"
#include "capture/source_text.hpp"
#include "capture/text.hpp"
#include "imev/block.hpp"
#include "imev/expected_values.hpp"
#include "tik/block_headers.hpp"
#include "tik/codec.hpp"
#include "tik/file_layout.hpp"

namespace nutik::tik {
namespace {

constexpr std::string_view kComment = kCaptureComment;
constexpr std::string_view kPurpose =
    " - an image evolution model; the picture is the first sample, change records follow it.";
constexpr std::string_view kNoise = "noise";
constexpr std::size_t kLongestHeader = 65'536;

// Tags of fields. `rice` stands where blocks may be packed with that codec, which the first programs of version 1 do
// not know: with a tolerance whatever codec was asked for.
constexpr std::string_view kPixelAspect = "aspc", kPrimaries = "prim", kFacts = "fact", kAligned = "algn",
                           kMeans = "mean", kRounded = "rond", kRice = "rice", kSteps = "step", kPart = "part",
                           kClip = "clip", kMade = "made", kFilmed = "film";
constexpr std::array kKnownFields{kPixelAspect, kPrimaries, kFacts, kAligned, kMeans, kRounded,
                                  kRice,        kSteps,     kPart,  kClip,    kMade,  kFilmed};

class HeaderParser {
 public:
  HeaderParser(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  ParsedHeader parse() {
    check_kind();
    const bool colour = text_[1] == '6';
    std::map<std::string, std::string, std::less<>> words = take_comments();
    ParsedHeader parsed;
    parsed.header.version = version_;
    parsed.header.roundings.add(0.0, 1.0, kUnknown);  // unless a field tells
    CaptureFormat& capture = parsed.header.capture;
    capture.shape.width = take_number();
    capture.shape.height = take_number();
    capture.shape.channels = colour ? 3 : 1;
    const std::uint32_t maximum = take_number();
    if (at_ >= text_.size() || text_[at_] != '\n') fail("the line before the picture does not end");
    parsed.raster_offset = at_ + 1;

    const std::uint32_t depth = number_of(words, "depth");
    capture.code_bytes = depth / 8;
    capture.white_code = number_of(words, "white code");
    if ((depth != 8 && depth != 16) || capture.white_code != maximum || !mistake_in(capture).empty())
      fail("its comments contradict its picture");
    try {
      capture.transfer = Transfer::parse(words["transfer"]);
      if (noise_.empty()) {
        capture.noise.tolerance = number_of(words, "tolerance");
      } else {
        take_noise(words, capture);
      }
      parsed.header.shutter_angle = Rational::parse(first_word(words["shutter angle"]), "shutter angle");
      const std::string_view rate = first_word(words["rate"]);
      if (rate != "irregular") parsed.header.rate = Rational::parse(rate, "rate");
    } catch (const UsageError& error) {
      fail(error.what());
    }
    parsed.header.codec = words["codec"];
    return parsed;
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw InputError(format("{}: the header is damaged: {}", name_, why));
  }

  [[noreturn]] void fail_other_program() const {
    throw InputError(
        format("{} is a TIK file of another program, whose records have another layout; "
               "encode its source clip again",
               name_));
  }

  void check_kind() {
    if (!begins_as_netpbm(text_)) {
      throw InputError(format("{} is no .tik capture; a clip becomes one when it is encoded", name_));
    }
    at_ = 3;
    const auto line_end = text_.find('\n', at_);
    const std::string_view line = text_.substr(at_, line_end - at_);
    if (!line.starts_with(kComment)) {
      const auto ours = text_.substr(0, 512).find(kComment);
      if (ours != text_.npos && text_.substr(ours + kComment.size()).find_first_of("0123456789") == 0)
        fail("the text at the file's start was changed, line ends perhaps, and must be as it was written");
      const bool mentions = text_.substr(0, 512).find("TIK") != std::string_view::npos;
      if (mentions) fail_other_program();
      throw InputError(
          format("{} is a Netpbm picture, not a .tik file; to use it as a sample, encode it", name_));
    }
    const std::string_view rest = line.substr(kComment.size());
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), version_);
    if (error != std::errc() || (end != rest.data() + rest.size() && *end != ' ')) {
      fail_other_program();
    }
    if (version_ > kVersion) {
      throw InputError(format("{} is a .tik of version {}; this program reads versions up to {}", name_,
                              version_, kVersion));
    }
    if (text_[1] != '5' && text_[1] != '6') fail("its picture is neither P5 nor P6");
  }

  void take_noise(std::map<std::string, std::string, std::less<>>& words, CaptureFormat& capture) {
    NoiseModel& noise = capture.noise;
    const std::string_view sigmas = first_word(words["sigmas"]);
    const auto [end, error] = std::from_chars(sigmas.data(), sigmas.data() + sigmas.size(), noise.sigmas);
    if (error != std::errc() || end != sigmas.data() + sigmas.size() || !(noise.sigmas > 0)) {
      fail(format("its sigmas are '{}'", words["sigmas"]));
    }
    noise.camera = parse_noise(noise_, name_ + ", noise");
    if (noise.camera->channels.size() != capture.shape.channels ||
        capture.white_code != held_format(capture).white_code || capture.code_bytes != 2) {
      fail("its noise is that of other pictures");
    }
  }

  // `# TIK key: value` lines; others are skipped. The lines of the noise are kept apart.
  std::map<std::string, std::string, std::less<>> take_comments() {
    std::map<std::string, std::string, std::less<>> words;
    while (at_ < text_.size() && text_[at_] == '#') {
      const auto line_end = text_.find('\n', at_);
      if (line_end == std::string_view::npos) fail("it ends within a comment");
      const std::string_view line = text_.substr(at_, line_end - at_);
      const auto colon = line.find(": ");
      if (line.starts_with(kComment) && colon != std::string_view::npos) {
        const std::string_view key = line.substr(kComment.size(), colon - kComment.size());
        const std::string_view value = line.substr(colon + 2);
        if (key == kNoise) {
          noise_.append(value).append("\n");
        } else {
          words.emplace(key, value);
        }
      }
      at_ = line_end + 1;
    }
    return words;
  }

  std::uint32_t take_number() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n')) ++at_;
    std::uint32_t number = 0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), number);
    if (error != std::errc()) fail("a number is missing before the picture");
    at_ = static_cast<std::size_t>(end - text_.data());
    return number;
  }

  static std::string_view first_word(std::string_view text) {
    return text.substr(0, text.find_first_of(" ,"));
  }

  [[nodiscard]] std::uint32_t number_of(const std::map<std::string, std::string, std::less<>>& words,
                                        std::string_view key) const {
    const auto found = words.find(key);
    if (found == words.end()) fail(format("it does not say its {}", key));
    const std::string_view text = first_word(found->second);
    std::uint32_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) {
      fail(format("its {} is '{}'", key, found->second));
    }
    return number;
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
  std::uint32_t version_ = 0;
  std::string noise_;  // the text of its noise file
};

constexpr std::string_view kHeld = "held", kCut = "cut";

// `rigid 0 cut 12.5 0.4 0.1`
std::string text_of(const Alignment& alignment) {
  return format("{} {} {} {} {}{}", alignment.motion, alignment.reference,
                alignment.holds_unseen ? kHeld : kCut, alignment.moved_pixels, alignment.turned_degrees,
                alignment.residual_pixels ? format(" {}", *alignment.residual_pixels) : "");
}

// Takes words off the front of a text.
class Words {
 public:
  Words(std::string_view text, const char* subject) : rest_(text), subject_(subject) {}

  std::string_view next() {
    const std::size_t end = rest_.find(' ');
    const std::string_view first = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    return first;
  }
  template <typename Value>
  void take(Value& value) {
    const std::string_view digits = next();
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size()) fail();
  }
  [[nodiscard]] std::string_view rest() const { return rest_; }
  [[noreturn]] void fail() const { throw UsageError(format("what it says of its {} is damaged", subject_)); }

 private:
  std::string_view rest_;
  const char* subject_;
};

Alignment parse_alignment(std::string_view text) {
  Words words(text, "alignment");
  Alignment alignment;
  alignment.motion = printable(words.next());
  words.take(alignment.reference);
  alignment.holds_unseen = words.next() == kHeld;
  words.take(alignment.moved_pixels);
  words.take(alignment.turned_degrees);
  if (!words.rest().empty()) words.take(alignment.residual_pixels.emplace());
  return alignment;
}

// `2 20000000 6 street.mov`
std::string text_of(const PartOfClip& part) {
  return format("{} {} {} {}", part.first, part.start_ns, part.pictures, part.clip);
}

PartOfClip parse_part(std::string_view text) {
  constexpr std::uint64_t kMax = std::uint64_t{1}
                                 << 62;  // so that a capture's pictures and times can be added
  Words words(text, "place in a clip");
  PartOfClip part;
  words.take(part.first);
  std::uint64_t start_ns = 0;
  words.take(start_ns);
  words.take(part.pictures);
  part.clip = printable(words.rest());
  if (part.first >= kMax || start_ns >= kMax) words.fail();
  part.start_ns = static_cast<std::int64_t>(start_ns);
  return part;
}

// Throws UsageError where a value is none.
void take_fields(std::span<const Field> fields, Header& header) {
  CaptureFormat& capture = header.capture;
  for (const Field& field : fields) {
    if (field.tag == kPixelAspect && field.data.size() == 2 * sizeof(std::uint32_t)) {
      std::array<std::uint32_t, 2> aspect{};
      std::memcpy(aspect.data(), field.data.data(), sizeof aspect);
      if (aspect[0] == 0) throw UsageError("its pixel aspect is 0");
      capture.pixel_aspect = Rational::of(aspect[0], aspect[1]);
    } else if (field.tag == kPrimaries) {
      capture.primaries = parse_primaries(field.data);
    } else if (field.tag == kAligned) {
      header.alignment = parse_alignment(field.data);
    } else if (field.tag == kMeans) {
      header.is_scaled = true;
    } else if (field.tag == kRounded) {
      header.roundings = CodeRoundings::parse(field.data);
    } else if (field.tag == kPart) {
      header.part = parse_part(field.data);
    } else if (field.tag == kClip && header.part) {
      header.part->checksum = printable(field.data);
    } else if (field.tag == kMade) {
      header.made = MadeSamples::parse(field.data);
    } else if (field.tag == kFilmed && field.data.starts_with('\0')) {  // the first exposure starts at 0
      header.filmed = load_exposures(std::as_bytes(std::span(field.data)));
    } else if (field.tag == kFilmed) {
      header.filmed = Rational::parse(field.data, "rate of what was filmed");
    } else if (field.tag == kFacts) {
      for (std::size_t at = 0; at < field.data.size();) {
        const std::size_t end = std::min(field.data.find('\n', at), field.data.size());
        header.facts.push_back(printable(std::string_view(field.data).substr(at, end - at)));
        at = end + 1;
      }
    }
  }
}

std::string_view front_text(std::span<const std::byte> file) {
  return as_text(file).substr(0, kLongestHeader);
}

// The picture at the front, of all pixels and not packed: what a file says of its size is true, and whatever is
// allocated for it no surprise.
void check_raster(const ParsedHeader& parsed, std::uint64_t file_bytes, const std::string& name) {
  const Shape& shape = parsed.header.capture.shape;
  // So that its bytes can be counted in 64 bits.
  const bool is_possible = shape.pixel_count() <= file_bytes;
  if (is_possible && parsed.raster_offset + raster_bytes(parsed.header.capture) < file_bytes) return;
  throw InputError(
      format("{}: it was cut off or is damaged: it states {} x {} pixels, which its {} bytes do not hold",
             name, shape.width, shape.height, file_bytes));
}

}  // namespace

FilmedTimes filmed_times(const Timeline& filmed) {
  if (filmed.is_constant()) return filmed.rate();
  return std::vector(filmed.table().begin(), filmed.table().end());
}

std::string Header::text() const {
  const Shape& shape = capture.shape;
  std::string text = shape.channels == 3 ? "P6\n" : "P5\n";
  const auto line = [&](std::string_view key, const std::string& value) {
    text += format("{}{}: {}\n", kComment, key, value);
  };
  text += format("{}{}{}\n", kComment, kVersion, kPurpose);
  line("size", format("{} x {}", shape.width, shape.height));
  line("channels", format("{}", shape.channels));
  line("depth", format("{} bits", capture.code_bytes * 8));
  line("white code", format("{}", capture.white_code));
  line("rate", rate ? format("{} samples a second", rate->text()) : "irregular, every exposure is listed");
  line("shutter angle", format("{} degrees", shutter_angle.text()));
  line("transfer", capture.transfer.text());
  line("pixel aspect", format("{}:{}", capture.pixel_aspect.numerator, capture.pixel_aspect.denominator));
  line("primaries", std::string(to_text(capture.primaries)));
  if (capture.noise.camera) {
    line("sigmas", format("{} standard deviations", capture.noise.sigmas));
    for (const std::string& each : noise_lines(*capture.noise.camera)) line(kNoise, each);
  } else {
    line("tolerance", format("{} codes", capture.noise.tolerance));
  }
  line("codec", codec);
  text += format("{} {}\n{}\n", shape.width, shape.height, capture.white_code);
  return text;
}

std::vector<Field> Header::fields() const {
  std::vector<Field> fields;
  if (capture.pixel_aspect != Rational{1, 1}) {
    const std::array<std::uint32_t, 2> aspect{static_cast<std::uint32_t>(capture.pixel_aspect.numerator),
                                              static_cast<std::uint32_t>(capture.pixel_aspect.denominator)};
    fields.push_back({std::string(kPixelAspect), false,
                      std::string(reinterpret_cast<const char*>(aspect.data()), sizeof aspect)});
  }
  if (capture.primaries != Primaries::bt709) {
    fields.push_back({std::string(kPrimaries), true, std::string(to_text(capture.primaries))});
  }
  std::string lines;
  for (const std::string& fact : facts) lines += fact + "\n";
  if (!lines.empty()) fields.push_back({std::string(kFacts), false, lines});
  if (alignment) fields.push_back({std::string(kAligned), false, text_of(*alignment)});
  if (is_scaled) fields.push_back({std::string(kMeans), false, "scaled"});
  fields.push_back({std::string(kRounded), false, roundings.text()});
  // Where codes move by steps, every codec may leave blocks to Rice's.
  const bool counts_steps = capture.noise.tolerance > 0 && !codec.empty() && codec != Codec().text();
  if (codec == kRice || counts_steps) fields.push_back({std::string(kRice), true, "1"});
  if (counts_steps) fields.push_back({std::string(kSteps), true, "1"});
  if (part) fields.push_back({std::string(kPart), false, text_of(*part)});
  if (part && !part->checksum.empty()) fields.push_back({std::string(kClip), false, part->checksum});
  if (made) fields.push_back({std::string(kMade), false, made->kept_text()});
  if (filmed) {
    const auto* const rate = std::get_if<Rational>(&*filmed);
    fields.push_back({std::string(kFilmed), false,
                      rate ? rate->text() : std::string(as_text(std::as_bytes(std::span(std::get<1>(*filmed)))))});
  }
  return fields;
}

void refuse_unknown(std::span<const Field> fields, const std::string& name) {
  for (const Field& field : fields) {
    if (!field.must_be_understood || std::ranges::count(kKnownFields, field.tag) > 0) continue;
    throw InputError(
        format("{} holds what this program does not know and must not pass over ({}); read it with "
               "a later one",
               name, quoted(field.tag)));
  }
}

std::uint64_t raster_bytes(const CaptureFormat& capture) {
  return capture.shape.value_count() * (capture.white_code > 255 ? 2 : 1);
}

bool looks_like_tik(std::span<const std::byte> file) {
  return begins_as_capture(front_text(file));
}

ParsedHeader parse_header(std::span<const std::byte> file, const std::string& name) {
  try {
    ParsedHeader parsed = HeaderParser(front_text(file), name).parse();
    check_raster(parsed, file.size(), name);
    parsed.first_block_offset =
        align_up(parsed.raster_offset + raster_bytes(parsed.header.capture) + 1, kAlignment);
    if (parsed.header.version == 0) return parsed;
    const auto behind = file.subspan(std::min<std::uint64_t>(parsed.first_block_offset, file.size()));
    const ReadFields read = read_fields(behind, name);
    parsed.first_block_offset = align_up(parsed.first_block_offset + read.bytes, kAlignment);
    refuse_unknown(read.fields, name);
    take_fields(read.fields, parsed.header);
    return parsed;
  } catch (const UsageError& error) {  // a value that a person may not state either
    throw InputError(format("{}: the text at its start is damaged: {}", name, error.what()));
  }
}

}  // namespace nutik::tik
