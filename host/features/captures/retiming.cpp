#include "features/captures/retiming.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "capture/error.hpp"
#include "capture/fact.hpp"
#include "capture/format.hpp"
#include "media/clip.hpp"
#include "media/settled_fact.hpp"
#include "session/clips/evened_times.hpp"
#include "session/clips/source_check.hpp"
#include "session/requests/source_request.hpp"
#include "session/text/number_text.hpp"
#include "system/input_bytes.hpp"
#include "system/interruption.hpp"
#include "system/is_absent.hpp"
#include "tik/reader.hpp"
#include "tik/writer.hpp"

namespace nutik {

std::optional<Setting> correction_of(std::string_view fact) {
  const std::string_view text = statement_of(fact);
  if (text.find("pictures a second") != text.npos || text.starts_with("a picture every "))
    return Setting::frame_rate;
  if (text.starts_with("shutter ")) return Setting::shutter_angle;
  if (text.starts_with("transfer ")) return Setting::transfer;
  if (text.starts_with("primaries ")) return Setting::primaries;
  if (text.starts_with("pixels ") || text == pixel_aspect_text({1, 1})) return Setting::pixel_aspect;
  return std::nullopt;
}

bool lists_exposures(const tik::Header& header) {
  const auto is_listed = [](std::string_view fact) {
    return correction_of(fact) == Setting::shutter_angle && fact.find(", from ") != fact.npos;
  };
  return !header.rate && std::ranges::any_of(header.facts, is_listed);
}

namespace {

// Whether a camera wrote down for how long its shutter was open: so long it was at any rate.
bool is_timed_shutter(std::string_view line) {
  return correction_of(line) == Setting::shutter_angle && line.find(", from ") != line.npos &&
         line.ends_with(" ns");
}

std::vector<std::int64_t> starts_of(const Timeline& irregular) {
  std::vector<std::int64_t> starts;
  for (const Exposure& exposure : irregular.table()) starts.push_back(exposure.start_ns);
  return starts;
}

Timeline timeline_of(const RetimeRequest& request, const tik::Header& header, const Timeline& before) {
  if (!request.rate && !request.shutter_angle) return before;
  if (header.made) {
    throw UsageError(format("{} has samples made between its pictures, whose times follow from these; encode the clip "
                            "again with the right ones",
                            request.capture.string()),
                     {Setting::frame_rate, Setting::shutter_angle});
  }
  if (request.rate && !request.shutter_angle && std::ranges::any_of(header.facts, is_timed_shutter)) {
    ClipInfo timed;
    timed.timing.exposed_ns = before.end_ns(0) - before.start_ns(0);
    ClipOptions stated;
    stated.rate = request.rate;
    return timeline_of(request.capture.string(), timed, stated, before.sample_count());
  }
  const Rational angle = request.shutter_angle.value_or(before.shutter_angle());
  if (request.rate || before.is_constant()) {
    return Timeline::constant(request.rate.value_or(before.rate()), angle, before.sample_count());
  }
  ClipInfo irregular;
  irregular.timing.starts_ns = starts_of(before);
  // A part of a clip ends where the clip's next picture starts.
  if (header.part && !lists_exposures(header)) irregular.timing.starts_ns.push_back(before.duration_ns());
  return timeline_of(request.capture.string(), irregular, ClipOptions(), angle, before.sample_count());
}

// Those that still hold, and what was stated now in the places of what it corrects.
std::vector<std::string> facts_of(const RetimeRequest& request, const tik::Header& before,
                                  const Timeline& timeline) {
  std::vector<std::string> facts = before.facts;
  const auto state = [&](Setting setting, const std::string& text) {
    const std::string line = Fact{text, Origin::stated, setting}.line();
    const auto corrected = std::ranges::find_if(
        facts, [&](const std::string& fact) { return correction_of(fact) == setting; });
    if (corrected == facts.end()) {
      facts.push_back(line);
    } else {
      *corrected = line;
    }
  };
  const std::string shutter = format("shutter {} degrees", timeline.shutter_angle().text());
  for (std::string& fact : facts) {
    if (is_timed_shutter(fact)) restate(fact, shutter);
    if (before.part && tells_part(fact))
      restate(fact, before.part->text(before.part->first + timeline.sample_count()));
  }
  if (request.rate) state(Setting::frame_rate, rate_text(*request.rate, "picture"));
  if (request.shutter_angle) state(Setting::shutter_angle, shutter);
  if (request.transfer) state(Setting::transfer, "transfer " + request.transfer->text());
  if (request.primaries) state(Setting::primaries, format("primaries {}", to_text(*request.primaries)));
  if (request.pixel_aspect) state(Setting::pixel_aspect, pixel_aspect_text(*request.pixel_aspect));
  return facts;
}

}  // namespace

Retimed retime(const RetimeRequest& request) {
  if (is_standard_input(request.output.string()))
    throw UsageError("standard input cannot be changed in place", Advice{"; state `output NEW.tik`"});
  if (!is_absent(request.capture) && !is_tik(request.capture)) {
    throw InputError(
        format("{} is no .tik capture, and only those are corrected: state a clip's rate, angle and "
               "transfer function when it is encoded",
               request.capture.string()),
        {Setting::frame_rate, Setting::shutter_angle, Setting::transfer});
  }
  if (request.changes_nothing()) {
    throw UsageError(
        "what is to be corrected? State rate, angle, transfer function, primaries or pixel aspect",
        {Setting::frame_rate, Setting::shutter_angle, Setting::transfer, Setting::primaries,
         Setting::pixel_aspect});
  }
  const tik::Reader reader(request.capture);
  tik::Header header = reader.header();
  CaptureFormat& capture = header.capture;
  check_stated_transfer(header, request.capture.string(), request.transfer);
  const Timeline timeline = timeline_of(request, header, reader.timeline());
  header.rate = timeline.is_constant() ? std::optional(timeline.rate()) : std::nullopt;
  header.shutter_angle = timeline.shutter_angle();
  capture.transfer = request.transfer.value_or(capture.transfer);
  capture.primaries = request.primaries.value_or(capture.primaries);
  capture.pixel_aspect = request.pixel_aspect.value_or(capture.pixel_aspect);
  // A part of a clip begins where the rate says that its first picture does.
  if (header.part && request.rate)
    header.part->start_ns = Timeline::constant(*request.rate, Timeline::kFullShutter,
                                               header.part->first + timeline.sample_count())
                                .start_ns(header.part->first);
  header.facts = facts_of(request, header, timeline);

  auto writer = tik::Writer::from_raster(request.output, header, reader.first_sample());
  for (std::uint64_t block = 0; block < reader.block_count(); ++block) {
    check_interruption();
    const auto [stored, payload] = reader.stored(block);
    std::span<const Exposure> exposures;
    if (!timeline.is_constant()) {
      exposures = timeline.table().subspan(stored.first_sample, stored.sample_count);
    }
    writer.append(stored, payload, exposures);
  }
  writer.finish(timeline);
  std::vector<Note> notes;
  const bool is_limited = std::ranges::any_of(
      header.facts, [](std::string_view fact) { return statement_of(fact) == "limited range"; });
  if (const auto& stated = request.transfer; stated && is_limited && *stated != stated->scaled_from_video()) {
    notes.emplace_back(format("codes of limited range were scaled to the full one, and {} holds for the former: "
                              "encoding by it makes them {}; state that",
                              stated->text(), stated->scaled_from_video().text()),
                       std::vector{Setting::transfer});
  }
  if (request.rate && !reader.timeline().is_constant()) {
    if (auto note = evened_note(starts_of(reader.timeline()))) notes.push_back(std::move(*note));
  }
  return {capture, timeline, writer.bytes_written(), header.facts, std::move(notes)};
}

}  // namespace nutik
