#include "session/retiming.hpp"

#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "capture/error.hpp"
#include "capture/fact.hpp"
#include "session/time_text.hpp"
#include "system/interruption.hpp"
#include "tik/reader.hpp"
#include "tik/writer.hpp"

namespace nutik {
namespace {

Timeline timeline_of(const RetimeRequest& request, const Timeline& before) {
  if (!request.rate && !request.shutter_angle) return before;
  const Rational angle = request.shutter_angle.value_or(before.shutter_angle());
  if (request.rate || before.is_constant()) {
    return Timeline::constant(request.rate.value_or(before.rate()), angle, before.sample_count());
  }
  std::vector<std::int64_t> starts;
  for (const Exposure& exposure : before.table()) starts.push_back(exposure.start_ns);
  return Timeline::irregular(std::move(starts), angle);
}

// Of a fact's line what is stated, without who said so and what else was said.
std::string_view stated_by(std::string_view line) {
  for (const std::string_view origin : {", from ", ", as stated", ", assumed"}) {
    line = line.substr(0, line.find(origin));
  }
  return line;
}

// Those that still hold, and what was stated now.
std::vector<std::string> facts_of(const RetimeRequest& request, const tik::Header& before) {
  std::vector<std::string> facts = before.facts;
  const auto state = [&](Setting setting, std::string_view kind, const std::string& text) {
    std::erase_if(facts,
                  [&](const std::string& fact) { return stated_by(fact).find(kind) != std::string::npos; });
    facts.push_back(Fact{text, Origin::stated, setting}.line());
  };
  if (request.rate) state(Setting::frame_rate, "picture", rate_text(*request.rate, "picture"));
  if (request.shutter_angle)
    state(Setting::shutter_angle, "shutter", format("shutter {} degrees", request.shutter_angle->text()));
  if (request.transfer) state(Setting::transfer, "transfer", "transfer " + request.transfer->text());
  if (request.primaries)
    state(Setting::primaries, "primaries", format("primaries {}", to_text(*request.primaries)));
  if (request.pixel_aspect) {
    state(Setting::pixel_aspect, "pixels",
          format("pixels {}:{}", request.pixel_aspect->numerator, request.pixel_aspect->denominator));
  }
  return facts;
}

}  // namespace

Retimed retime(const RetimeRequest& request) {
  if (request.changes_nothing()) {
    throw UsageError(
        "what is to be corrected? State rate, angle, transfer function, primaries or pixel aspect",
        {Setting::frame_rate, Setting::shutter_angle, Setting::transfer, Setting::primaries,
         Setting::pixel_aspect});
  }
  const tik::Reader reader(request.capture);
  tik::Header header = reader.header();
  CaptureFormat& capture = header.capture;
  if (request.transfer && *request.transfer != capture.transfer && capture.noise.camera) {
    throw UsageError(
        format("{} holds means of light by {}: with another transfer function they are others; encode "
               "the clip again with it",
               request.capture.string(), capture.transfer.text()),
        {Setting::transfer});
  }
  const Timeline timeline = timeline_of(request, reader.timeline());
  header.rate = timeline.is_constant() ? std::optional(timeline.rate()) : std::nullopt;
  header.shutter_angle = timeline.shutter_angle();
  capture.transfer = request.transfer.value_or(capture.transfer);
  capture.primaries = request.primaries.value_or(capture.primaries);
  capture.pixel_aspect = request.pixel_aspect.value_or(capture.pixel_aspect);
  header.facts = facts_of(request, reader.header());

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
  return {capture, timeline, writer.bytes_written()};
}

}  // namespace nutik
