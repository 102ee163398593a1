#include "features/activity/activity.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <utility>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/mask_check.hpp"
#include "imev/activity.hpp"
#include "imev/each_block.hpp"
#include "session/requests/named_inputs.hpp"
#include "session/requests/stated_moments.hpp"
#include "session/text/number_text.hpp"
#include "system/input_bytes.hpp"

namespace nutik {
namespace {

ActivityOptions options_of(const ActivityRequest& request, const CaptureFormat& capture) {
  ActivityOptions options{request.ignored_codes, {}, {}, {}};
  if (std::holds_alternative<std::monostate>(request.mask)) return options;
  const auto* const file = std::get_if<std::string>(&request.mask);
  const std::string name = file != nullptr ? input_title(*file) : "the mask";
  Mask mask = file != nullptr ? read_mask_input(*file) : *std::get<Shared<Mask>>(request.mask);
  check_size(mask, capture, file != nullptr ? name + ": " : std::string());
  if (request.each_tag) {
    options.tags = std::move(mask.tags);
    return options;
  }
  std::vector<std::uint8_t>& counted = options.counted;
  counted.resize(mask.tags.size());
  std::ranges::transform(mask.tags, counted.begin(), [&](std::uint8_t tag) {
    return static_cast<std::uint8_t>(request.tag ? tag == *request.tag : tag != 0);
  });
  if (std::ranges::find(counted, 1) == counted.end()) {
    throw InputError(request.tag ? format("{} has no pixel with tag {}", name, *request.tag)
                                 : format("{} is 0 everywhere; no pixel counts", name));
  }
  return options;
}

std::vector<TagActivity> tag_activities(const Activity& activity, const std::vector<std::uint8_t>& tags) {
  std::array<std::uint64_t, kMaskValues> pixels{};
  for (const std::uint8_t tag : tags) ++pixels[tag];
  std::vector<TagActivity> activities;
  for (const auto& [tag, changed] : activity.changed_pixels_by_tag()) {
    const bool is_still = std::ranges::all_of(changed, [](std::uint64_t count) { return count == 0; });
    activities.push_back({tag, pixels[tag], is_still, activity_moments(changed)});
  }
  return activities;
}

Activity activity_of(CaptureSource& capture, const ActivityOptions& options,
                     const ReportedProgress& progress) {
  Activity activity(capture.format(), options);
  for_each_block(capture, [&](const BlockView& block) {
    const BlockExtent& extent = block.extent();
    activity.add(block, [&](std::uint32_t rows) {
      const std::uint64_t samples = std::uint64_t{extent.sample_count} * rows / capture.format().shape.height;
      if (progress) progress(extent.first_sample + samples, capture.timeline().sample_count());
    });
  });
  activity.bridge_left_out();
  return activity;
}

// Which samples are redrawn is known when all have been counted: if there are any, all are counted once more.
MeasuredActivity measured(CaptureSource& capture, ActivityOptions options, bool counts_redrawn,
                          const ReportedProgress& progress) {
  std::optional<Activity> first = activity_of(capture, options, progress);
  if (!counts_redrawn) options.left_out = redrawn_samples(*first);
  if (!options.left_out.empty()) {
    first.reset();  // before the other is there: needs() are those of one
    first = activity_of(capture, options, progress);
  }
  Activity activity = std::move(*first);
  auto moments = activity_moments(activity.changed_pixels());
  std::vector<TagActivity> tags = tag_activities(activity, options.tags);
  return {capture.timeline(), std::move(activity), std::move(options.left_out), std::move(moments),
          std::move(tags)};
}

double ratio(std::uint64_t part, std::uint64_t whole) {
  return static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

std::uint64_t MeasuredActivity::changes() const {
  const auto& changed = activity.changed_pixels();
  return std::accumulate(changed.begin(), changed.end(), std::uint64_t{0});
}

double MeasuredActivity::changed_share(std::uint64_t sample) const {
  return ratio(activity.changed_pixels()[sample], activity.pixel_count());
}

double MeasuredActivity::mean_share() const {
  const std::uint64_t count = timeline.sample_count();
  return count > 1 ? ratio(changes(), activity.pixel_count()) / static_cast<double>(count - 1) : 0.0;
}

bool MeasuredActivity::is_redrawn(std::uint64_t sample) const {
  return std::ranges::binary_search(redrawn, sample);
}

std::vector<Note> MeasuredActivity::notes() const {
  if (redrawn.empty()) return {};
  const auto stated = [&](std::uint64_t sample) { return stated_sample(sample, timeline).text(); };
  return {{format("at {} ({}{}) the whole picture changed a little at once, as with a codec's key frame or a camera's "
                  "new exposure; each counts as its neighbours do",
                  counted(redrawn.size(), "sample"), stated(redrawn.front()),
                  redrawn.size() > 1 ? " … " + stated(redrawn.back()) : ""),
           {Setting::count_redrawn}}};
}

SampleRange MeasuredActivity::moment(const std::string& name, bool quietest) const {
  return moment(name, quietest, {0, activity.pixel_count(), is_still(), moments});
}

SampleRange MeasuredActivity::moment(const std::string& name, bool quietest, const TagActivity& of) const {
  if (of.moments) return (quietest ? of.moments->quietest : of.moments->busiest).samples;
  if (of.is_still && quietest) return {0, timeline.sample_count()};
  throw InputError(format("{} has no {} moment{}: {}", name, quietest ? "quietest" : "busiest",
                          tags.empty() ? "" : format(" where the mask is {}", of.tag),
                          of.is_still ? "nothing changes" : "it has fewer than three samples"));
}

std::string MeasuredActivity::table() const {
  std::string text = "sample,start_ns,end_ns,changed_pixels,changed_share,redrawn\n";
  for (std::uint64_t k = 0; k < timeline.sample_count(); ++k) {
    text += format("{},{},{},{},{:.9g},{}\n", k, timeline.start_ns(k), timeline.end_ns(k),
                   activity.changed_pixels()[k], changed_share(k), is_redrawn(k) ? 1 : 0);
  }
  return text;
}

MeasuredActivity measure_activity(CaptureSource& capture, const ActivityRequest& request,
                                  const ReportedProgress& progress) {
  return measured(capture, options_of(request, capture.format()), request.counts_redrawn, progress);
}

MeasuredActivity measure_activity(Session& session, const ActivityRequest& request,
                                  const ReportedProgress& progress) {
  ActivityOptions options = options_of(request, session.format());
  const std::set<std::uint8_t> tags(options.tags.begin(), options.tags.end());
  MemoryNeeds needs = Activity::needs(session.format());
  std::uint64_t block_samples = 0;
  for (std::uint64_t block = 0; block < session.capture().block_count(); ++block)
    block_samples = std::max<std::uint64_t>(block_samples, session.capture().block_extent(block).sample_count);
  needs.add(Activity::needs_of_samples(session.timeline().sample_count(), tags.size(), block_samples));
  needs.add("a block", largest_block(session.capture()));
  needs.rest_of(session.devices().request().memory.bytes);
  return measured(session.capture(), std::move(options), request.counts_redrawn, progress);
}

}  // namespace nutik
