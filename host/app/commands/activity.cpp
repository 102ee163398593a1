#include "session/activity.hpp"

#include <algorithm>

#include "app/commands/commands.hpp"
#include "app/commands/opened_session.hpp"
#include "app/input/standard_input.hpp"
#include "app/output/json.hpp"
#include "app/output/output_name.hpp"
#include "app/output/progress.hpp"
#include "app/text/number_text.hpp"
#include "session/capture.hpp"
#include "session/error.hpp"
#include "session/format.hpp"
#include "session/functions.hpp"
#include "session/pictures.hpp"
#include "session/time_text.hpp"
#include "system/output_file.hpp"

namespace nutik::app {
namespace {

struct ActivityOutputs {
  std::optional<std::filesystem::path> chart;
  std::optional<std::filesystem::path> table;  // a file
  bool prints_table = false;
  std::optional<std::filesystem::path> map;
};

ActivityOutputs outputs_of(const Options& options) {
  ActivityOutputs outputs;
  outputs.chart = stated_output(options.output, options.operands, "activity");
  std::vector<std::string> inputs = input_files(options);
  const auto check = [&](const std::filesystem::path& path, OutputKind kind) {
    check_output(path, kind, inputs);
    inputs.push_back(path.string());  // no two outputs of one name either
  };
  if (outputs.chart) {
    check(*outputs.chart, OutputKind::picture);
    constexpr std::uint32_t kColour = 3;
    static_cast<void>(value_type_for(*outputs.chart, Depth::bits8, ValueType::code8, kColour));
  }
  if (options.map) {
    outputs.map = *options.map;
    check(*outputs.map, OutputKind::picture);
    static_cast<void>(value_type_for(*outputs.map, Depth::bits8, ValueType::code8, 1));
  }
  outputs.prints_table = options.csv == "-";
  if (options.csv && !outputs.prints_table) {
    outputs.table = *options.csv;
    check(*outputs.table, OutputKind::table);
  }
  if (outputs.prints_table && options.json)
    throw UsageError("--csv - and --json both go to standard output; use one");
  if (options.moment && *options.moment != "quietest" && *options.moment != "busiest")
    throw UsageError(format("--moment '{}' is neither quietest nor busiest", *options.moment));
  if (options.moment && (outputs.prints_table || options.json))
    throw UsageError("--moment prints nothing else; leave --csv - and --json away");
  return outputs;
}

// The pixels that count: all of them, those with a tag, or those with any tag but 0.
std::vector<std::uint8_t> counted_pixels(const Options& options, const Shape& shape) {
  if (!options.mask) {
    if (options.tag) throw UsageError("--tag is one of a mask; add -m mask.pgm");
    return {};
  }
  const Mask mask = read_mask_input(*options.mask);
  if (mask.width != shape.width || mask.height != shape.height) {
    throw InputError(format("{} is {} x {}, the capture {} x {}; they must be of one size",
                            input_title(*options.mask), mask.width, mask.height, shape.width, shape.height));
  }
  const bool is_any = !options.tag;
  const std::uint32_t wanted = is_any ? 0 : parse_whole_number(*options.tag, "tag", 0, 255);
  std::vector<std::uint8_t> counted(mask.tags.size());
  std::ranges::transform(mask.tags, counted.begin(), [&](std::uint8_t tag) {
    return static_cast<std::uint8_t>(is_any ? tag != 0 : tag == wanted);
  });
  if (std::ranges::find(counted, 1) == counted.end()) {
    throw InputError(is_any ? format("{} is 0 everywhere; no pixel counts", input_title(*options.mask))
                            : format("{} has no pixel with tag {}", input_title(*options.mask), wanted));
  }
  return counted;
}

double share_of(std::uint64_t changes, std::uint64_t pixels) {
  return static_cast<double>(changes) / static_cast<double>(pixels);
}

std::string table_text(const Timeline& timeline, const Activity& activity) {
  std::string text = "sample,start_ns,end_ns,changed_pixels,changed_share\n";
  for (std::size_t k = 0; k < activity.changed_pixels().size(); ++k) {
    const std::uint64_t changes = activity.changed_pixels()[k];
    text += format("{},{},{},{},{:.9g}\n", k, timeline.start_ns(k), timeline.end_ns(k), changes,
                   share_of(changes, activity.pixel_count()));
  }
  return text;
}

// A stretch's mean share.
double mean_share(const ActivityStretch& stretch, std::uint64_t pixels) {
  return share_of(stretch.changes, pixels) / static_cast<double>(stretch.samples.size());
}

Json stretch_json(const ActivityStretch& stretch, const Timeline& timeline, std::uint64_t pixels) {
  return {{"first_sample", stretch.samples.first},
          {"last_sample", stretch.samples.last - 1},
          {"start_ns", timeline.start_ns(stretch.samples.first)},
          {"end_ns", timeline.end_ns(stretch.samples.last - 1)},
          {"mean_changed_share", mean_share(stretch, pixels)}};
}

void report_json(const std::string& name, const Timeline& timeline, const Activity& activity,
                 const std::optional<ActivityMoments>& moments) {
  const std::uint64_t pixels = activity.pixel_count();
  Json json{{"capture", name}, {"duration_ns", timeline.duration_ns()}, {"counted_pixels", pixels}};
  if (moments) {
    json["busiest_sample"] = moments->busiest_sample;
    json["busiest"] = stretch_json(moments->busiest, timeline, pixels);
    json["quietest"] = stretch_json(moments->quietest, timeline, pixels);
  }
  json["samples"] = Json::array();
  for (std::size_t k = 0; k < activity.changed_pixels().size(); ++k) {
    json["samples"].push_back({{"sample", k},
                               {"start_ns", timeline.start_ns(k)},
                               {"end_ns", timeline.end_ns(k)},
                               {"changed_pixels", activity.changed_pixels()[k]},
                               {"changed_share", share_of(activity.changed_pixels()[k], pixels)}});
  }
  print_json(json);
}

std::string stretch_text(const ActivityStretch& stretch, const Timeline& timeline, std::uint64_t pixels) {
  return format("{} to {} ({}f to {}f), {:.3g} % of pixels change at a sample",
                duration_text(timeline.start_ns(stretch.samples.first)),
                duration_text(timeline.reach_end_ns(stretch.samples.last - 1)), stretch.samples.first,
                stretch.samples.last - 1, 100 * mean_share(stretch, pixels));
}

void report_text(const std::string& name, const Timeline& timeline, const Activity& activity,
                 const std::optional<ActivityMoments>& moments) {
  const std::uint64_t pixels = activity.pixel_count();
  std::uint64_t total = 0;
  for (const std::uint64_t changes : activity.changed_pixels()) total += changes;
  const std::uint64_t count = timeline.sample_count();
  print_line(format("{}: {} samples in {}, {:.3g} % of {} pixels change at a sample, on average", name, count,
                    duration_text(timeline.duration_ns()),
                    count > 1 ? 100 * share_of(total, pixels) / static_cast<double>(count - 1) : 0.0,
                    pixels));
  if (!moments) {
    print_line(total == 0 ? "  nothing changes" : "  too short to tell where it is quiet");
    return;
  }
  const std::uint64_t busiest = moments->busiest_sample;
  print_line(format("  most at once  {} ({}f), {:.3g} %", duration_text(timeline.start_ns(busiest)), busiest,
                    100 * share_of(activity.changed_pixels()[busiest], pixels)));
  print_line(format("  busiest       {}", stretch_text(moments->busiest, timeline, pixels)));
  print_line(format("  quietest      {}", stretch_text(moments->quietest, timeline, pixels)));
  if (2 * total > pixels * (count - 1)) {
    print_note(
        "note: most pixels change at every sample, as noise does; --by CODES counts larger changes only");
  }
}

// The stretch that --moment asks for, as options of another command. Where nothing changes all is quiet.
std::string moment_text(const std::string& name, const std::string& wanted, const Timeline& timeline,
                        const Activity& activity, const std::optional<ActivityMoments>& moments) {
  const bool is_quietest = wanted == "quietest";
  const bool is_still =
      std::ranges::all_of(activity.changed_pixels(), [](auto changes) { return changes == 0; });
  if (!moments && !(is_still && is_quietest)) {
    throw InputError(format("{} has no {} moment: {}", name, wanted,
                            is_still ? "nothing changes" : "it has fewer than three samples"));
  }
  SampleRange samples{0, timeline.sample_count()};
  if (moments) samples = (is_quietest ? moments->quietest : moments->busiest).samples;
  return format("--start {}f --exposure {}f", samples.first, samples.size());
}

}  // namespace

int run_activity(const Options& options) {
  const ActivityOutputs outputs = outputs_of(options);
  const std::string& name = options.operands.front();
  ActivityOptions counting;
  if (options.by) counting.ignored_codes = parse_whole_number(*options.by, "--by", 0, 65'535);

  Session session = open_session(name, options);
  tik::Reader& capture = session.capture();
  const Timeline& timeline = capture.timeline();
  counting.counted = counted_pixels(options, capture.format().shape);
  Activity activity(capture.format(), std::move(counting));
  {
    Progress progress("counting", timeline.sample_count(), options.quiet);
    for_each_block(capture, [&](const BlockView& block) {
      progress.show(block.extent().first_sample);
      activity.add(block);
    });
  }
  const auto moments = activity_moments(activity.changed_pixels());

  if (outputs.chart) {
    write_picture(*outputs.chart,
                  sheet::activity_chart(std::filesystem::path(name).filename().string(), timeline,
                                        activity.changed_pixels(), activity.pixel_count(), moments));
  }
  if (outputs.map)
    write_picture(*outputs.map, sheet::activity_map(capture.format().shape, activity.changes()));
  if (outputs.table) {
    OutputFile file(*outputs.table);
    file.write(table_text(timeline, activity));
    file.commit();
  }
  if (options.moment) {
    print_line(moment_text(name, *options.moment, timeline, activity, moments));
  } else if (outputs.prints_table) {
    print_text(table_text(timeline, activity));
  } else if (options.json) {
    report_json(name, timeline, activity, moments);
  } else if (!options.quiet) {
    report_text(name, timeline, activity, moments);
    if (moments) {
      print_line(format("try: nutik-cl --start {}f --exposure {}f {} quiet.png",
                        moments->quietest.samples.first, moments->quietest.samples.size(), name));
    }
  }
  if (!options.quiet) {
    for (const std::string& line : source_lines(session)) print_note(line);
  }
  return 0;
}

}  // namespace nutik::app
