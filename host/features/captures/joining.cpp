#include "features/captures/joining.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "capture/fact.hpp"
#include "capture/format.hpp"
#include "capture/part_of_clip.hpp"
#include "features/captures/retiming.hpp"
#include "media/deflicker.hpp"
#include "session/output_check.hpp"
#include "session/text/number_text.hpp"
#include "system/interruption.hpp"
#include "tik/reader.hpp"
#include "tik/writer.hpp"

namespace nutik {
namespace {

constexpr std::string_view kJoined = "joined of ";

// What is known of a capture that is to be joined. Its file is not kept open: there may be thousands.
struct Piece {
  explicit Piece(const std::filesystem::path& path) : Piece(path.string(), tik::Reader(path)) {}
  Piece(std::string file, const tik::Reader& reader)
      : name(std::move(file)),
        header(reader.header()),
        timeline(reader.timeline()),
        checksum(reader.content_checksum()) {}

  [[nodiscard]] std::uint64_t end() const { return header.part->first + timeline.sample_count(); }

  std::string name;
  tik::Header header;
  Timeline timeline;
  std::uint64_t checksum;
};

std::string noise_text(const tik::Header& header) {
  const NoiseModel& noise = header.capture.noise;
  if (noise.camera) return format("changes beyond {} standard deviations of noise", noise.sigmas);
  return format("a tolerance of {} codes", noise.tolerance);
}

// Something that captures must have alike.
struct Trait {
  std::string (*text)(const tik::Header&);
  const char* way_out;
  std::vector<Setting> settings;
};

const char* const kEncodeAlike = "encode all parts with the same options";
const char* const kRetime = "retime the one that is wrong";

std::span<const Trait> traits() {
  using tik::Header;
  static const std::vector<Trait> kTraits{
      {[](const Header& h) { return format("pictures of {}", shape_text(h.capture.shape)); },
       kEncodeAlike,
       {Setting::crop, Setting::scale}},
      {[](const Header& h) {
         return format("codes of {} bits with white {}", h.capture.code_bytes * 8, h.capture.white_code);
       },
       kEncodeAlike,
       {Setting::white_code}},
      {[](const Header& h) { return "transfer " + h.capture.transfer.text(); }, kRetime, {Setting::transfer}},
      {[](const Header& h) { return format("primaries {}", to_text(h.capture.primaries)); },
       kRetime,
       {Setting::primaries}},
      {[](const Header& h) { return "pixels " + aspect_text(h.capture.pixel_aspect); },
       kRetime,
       {Setting::pixel_aspect}},
      {[](const Header& h) { return h.rate ? h.rate->text() + " pictures a second" : "irregular times"; },
       kRetime,
       {Setting::frame_rate}},
      {[](const Header& h) {
         // Their mean is another in each part.
         return lists_exposures(h) ? "listed exposures"
                                   : format("shutter {} degrees", h.shutter_angle.text());
       },
       kRetime,
       {Setting::shutter_angle}},
      {noise_text, kEncodeAlike, {}},
      {[](const Header& h) { return std::string(h.is_scaled ? "means of light" : "the clip's own pixels"); },
       kEncodeAlike,
       {Setting::scale}},
  };
  return kTraits;
}

// What facts state of codes, beside what traits compare.
std::vector<std::string_view> facts_of_codes(const tik::Header& header) {
  std::vector<std::string_view> stated;
  for (const std::string_view fact : header.facts) {
    if (!correction_of(fact) && !tells_part(fact) && !fact.starts_with(kJoined))
      stated.push_back(statement_of(fact));
  }
  return stated;
}

void check_alike(const Piece& first, const Piece& other) {
  for (const Trait& trait : traits()) {
    const std::string a = trait.text(first.header), b = trait.text(other.header);
    if (a == b) continue;
    throw InputError(format("{} has {}, and {} has {}; {}", first.name, a, other.name, b, trait.way_out),
                     trait.settings);
  }
  if (first.header.capture.noise != other.header.capture.noise) {
    throw InputError(format(
        "{} and {} were encoded with the noise of two cameras, or measured twice: measure it once, and "
        "encode all parts with that file",
        first.name, other.name));
  }
  const auto a = facts_of_codes(first.header), b = facts_of_codes(other.header);
  const auto lacks = [](const auto& facts, std::string_view fact) {
    return std::ranges::count(facts, fact) == 0;
  };
  for (const bool is_first : {true, false}) {
    for (const std::string_view fact : is_first ? a : b) {
      if (!lacks(is_first ? b : a, fact)) continue;
      throw InputError(format("{} was taken for '{}', and {} was not; {}", is_first ? first.name : other.name,
                              fact, is_first ? other.name : first.name, kEncodeAlike));
    }
  }
}

// What was made of a clip's pictures by other pictures of the same part cannot go on in the next.
void check_by_itself(const Piece& piece) {
  if (piece.header.alignment) {
    throw InputError(
        format("{} was aligned onto a picture of its own, and the parts would jump where they meet; align "
               "the whole clip: encode it in one go",
               piece.name));
  }
  if (piece.header.made) {
    throw InputError(format("{} has samples made between its pictures, and none could be made where it meets another; "
                            "encode the clip in one go",
                            piece.name),
                     {Setting::between});
  }
  if (std::ranges::count(facts_of_codes(piece.header), kDeflickered) > 0) {
    throw InputError(format("{} is exposed as its own first picture, and its brightness would jump where it "
                            "meets another; encode the clip in one go",
                            piece.name),
                     {Setting::deflicker});
  }
}

// `picture 7`, `pictures 7 … 9`
std::string pictures_text(std::uint64_t first, std::uint64_t end) {
  return end - first == 1 ? format("picture {}", first) : format("pictures {} … {}", first, end - 1);
}

// `known`: the last one before that tells its clip's content, if any does.
void check_seam(const Piece& before, const Piece& piece, const Piece& known) {
  const PartOfClip &a = *before.header.part, &b = *piece.header.part;
  if (a.clip != b.clip) {
    throw InputError(format("{} is a part of {}, and {} of {}; join parts of one clip", before.name, a.clip,
                            piece.name, b.clip));
  }
  if (a.pictures != b.pictures) {
    throw InputError(
        format("{} is a part of a clip {} with {} pictures, and {} of one with {}; join parts of one clip",
               before.name, a.clip, a.pictures, piece.name, b.pictures));
  }
  const std::string& content = known.header.part->checksum;
  if (content != b.checksum && !content.empty() && !b.checksum.empty()) {
    throw InputError(format("{} and {} are parts of two clips named {}, whose content differs; join parts of one clip",
                            known.name, piece.name, b.clip));
  }
  const std::vector settings{Setting::from, Setting::to};
  if (before.end() < b.first) {
    throw InputError(format("{} of {} are missing between {} and {}; encode them, and join all parts",
                            pictures_text(before.end(), b.first), b.clip, before.name, piece.name),
                     settings);
  }
  if (before.end() > b.first) {
    throw InputError(
        format("{} and {} both hold {} of {}; leave one out, or encode it without them", before.name,
               piece.name, pictures_text(b.first, std::min(before.end(), piece.end())), b.clip),
        settings);
  }
  const std::int64_t from_a = b.start_ns - a.start_ns;
  if (!before.header.rate && from_a < before.timeline.end_ns(before.timeline.sample_count() - 1)) {
    throw InputError(format("{} begins {} after {}, whose last exposure ends later; encode both with the "
                            "same rate and shutter angle",
                            piece.name, duration_text(from_a), before.name),
                     {Setting::frame_rate, Setting::shutter_angle});
  }
}

// That there is more of the clip: a part may have been forgotten.
std::vector<Note> missing_notes(const Piece& first, const Piece& last) {
  std::vector<Note> notes;
  const auto add = [&](std::uint64_t begin, std::uint64_t end) {
    if (begin < end)
      notes.emplace_back(
          format("{} of {} are in none of the captures", pictures_text(begin, end), first.header.part->clip));
  };
  add(0, first.header.part->first);
  add(last.end(), first.header.part->pictures);
  return notes;
}

// In the order of their times, once it is known that they follow each other. Returns what to know of that.
std::vector<Note> put_in_order(std::vector<Piece>& pieces) {
  const auto tells = [](const Piece& piece) { return piece.header.part.has_value(); };
  const auto teller = std::ranges::find_if(pieces, tells), silent = std::ranges::find_if_not(pieces, tells);
  if (silent != pieces.end() && teller != pieces.end()) {
    throw InputError(
        format("{} says which pictures of {} it holds, and {} does not; encode that as a part, too",
               teller->name, teller->header.part->clip, silent->name),
        {Setting::from, Setting::to});
  }
  if (silent != pieces.end()) {
    if (!pieces.front().header.rate) {
      throw InputError(format("{} has irregular times, and nothing says how long after its pictures those of "
                              "{} were taken; encode parts of one clip, or state a rate",
                              pieces.front().name, pieces[1].name),
                       {Setting::from, Setting::to, Setting::frame_rate});
    }
    return {Note(format(
        "no capture says where in a clip it lies: they are taken to follow each other at once, {} first",
        pieces.front().name))};
  }
  std::ranges::stable_sort(pieces, {}, [](const Piece& piece) { return piece.header.part->first; });
  const auto knows = [](const Piece& piece) { return !piece.header.part->checksum.empty(); };
  const Piece* known = &pieces.front();
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    check_seam(pieces[i - 1], pieces[i], *known);
    if (knows(pieces[i])) known = &pieces[i];
  }
  std::vector<Note> notes = missing_notes(pieces.front(), pieces.back());
  for (const Piece& piece : pieces) {
    if (knows(*known) && !knows(piece))
      notes.emplace_back(format("{} does not tell its clip's content: whether its {} is the clip of the others is not "
                                "known", piece.name, piece.header.part->clip));
  }
  return notes;
}

Timeline joined_timeline(const std::vector<Piece>& pieces) {
  const tik::Header& first = pieces.front().header;
  std::uint64_t samples = 0;
  for (const Piece& piece : pieces) samples += piece.timeline.sample_count();
  if (first.rate) return Timeline::constant(*first.rate, first.shutter_angle, samples);
  std::vector<Exposure> exposures;
  exposures.reserve(samples);
  std::int64_t from_first = 0;
  for (const Piece& piece : pieces) {
    from_first = piece.header.part->start_ns - first.part->start_ns;
    for (const Exposure& exposure : piece.timeline.table())
      exposures.push_back({exposure.start_ns + from_first, exposure.end_ns + from_first});
  }
  if (lists_exposures(first)) return Timeline::explicit_exposures(std::move(exposures));
  return Timeline::stored(std::move(exposures), from_first + pieces.back().timeline.duration_ns(),
                          first.shutter_angle);
}

// The first one's, with what is true of all of them.
tik::Header joined_header(const std::vector<Piece>& pieces, const Timeline& timeline) {
  tik::Header header = pieces.front().header;
  header.shutter_angle = timeline.shutter_angle();
  // A word for people, and a field for programs: whether any block may be packed so.
  const std::string packed = tik::Codec::parse("rice").text();
  for (const Piece& piece : pieces) {
    const std::string& codec = piece.header.codec;
    if (codec == packed || header.codec == tik::Codec().text()) header.codec = codec;
    header.roundings.take_worst(piece.header.roundings);
    if (header.part && piece.header.part->checksum.empty()) header.part->checksum.clear();
  }
  std::erase_if(header.facts, [](std::string_view fact) { return fact.starts_with(kJoined); });
  for (std::string& fact : header.facts) {
    if (header.part && tells_part(fact))
      restate(fact, header.part->text(header.part->first + timeline.sample_count()));
    if (header.rate) continue;
    if (correction_of(fact) == Setting::frame_rate) restate(fact, rate_text(timeline));
    if (correction_of(fact) == Setting::shutter_angle)
      restate(fact, format("shutter {} degrees", timeline.shutter_angle().text()));
  }
  const auto file = [](const Piece& piece) { return std::filesystem::path(piece.name).filename().string(); };
  header.facts.push_back(
      format("{}{} captures, {} … {}", kJoined, pieces.size(), file(pieces.front()), file(pieces.back())));
  return header;
}

// Appends a piece's blocks; returns how many samples there are then.
std::uint64_t copy(const Piece& piece, std::uint64_t first_sample, const Timeline& timeline,
                   tik::Writer& writer, const ReportedProgress& progress) {
  const tik::Reader reader(piece.name);
  if (reader.content_checksum() != piece.checksum)
    throw InputError(format("{} was written to while it was read; join again", piece.name));
  for (std::uint64_t block = 0; block < reader.block_count(); ++block) {
    check_interruption();
    auto stored = reader.stored(block);
    stored.header.first_sample += first_sample;
    std::span<const Exposure> exposures;
    if (!timeline.is_constant())
      exposures = timeline.table().subspan(stored.header.first_sample, stored.header.sample_count);
    writer.append(stored.header, stored.payload, exposures);
    reader.release(stored);
    if (progress) progress(stored.header.first_sample + stored.header.sample_count, timeline.sample_count());
  }
  return first_sample + piece.timeline.sample_count();
}

}  // namespace

Joined join(const JoinRequest& request, const ReportedProgress& progress) {
  if (request.captures.size() < 2) throw UsageError("two captures or more are joined");
  check_output(request.output, OutputKind::tik,
               std::vector<std::string>(request.captures.begin(), request.captures.end()));
  std::vector<Piece> pieces;
  for (const std::filesystem::path& path : request.captures) {
    check_interruption();
    pieces.emplace_back(path);
    check_by_itself(pieces.back());
    check_alike(pieces.front(), pieces.back());
  }
  std::vector<Note> notes = put_in_order(pieces);
  const Timeline timeline = joined_timeline(pieces);
  const tik::Header header = joined_header(pieces, timeline);

  auto writer =
      tik::Writer::from_raster(request.output, header, tik::Reader(pieces.front().name).first_sample());
  Joined joined{header.capture, timeline, {}, 0, header.facts, std::move(notes)};
  std::uint64_t samples = 0;
  for (const Piece& piece : pieces) {
    joined.parts.push_back({piece.name, samples, piece.timeline.sample_count()});
    samples = copy(piece, samples, timeline, writer, progress);
  }
  writer.finish(timeline);
  joined.file_bytes = writer.bytes_written();
  return joined;
}

}  // namespace nutik
