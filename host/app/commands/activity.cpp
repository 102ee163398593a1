#include "features/activity/activity.hpp"

#include "app/output/output_name.hpp"
#include "app/output/progress.hpp"
#include "app/output/report.hpp"
#include "app/words/stated_requests.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "features/schema/option.hpp"
#include "features/schema/options.hpp"
#include "media/writers/picture_writer.hpp"
#include "session/requests/stated_moments.hpp"
#include "session/text/number_text.hpp"
#include "session/text/shell_text.hpp"
#include "session/text/text_table.hpp"
#include "sheet/drawings.hpp"
#include "system/output_file.hpp"

namespace nutik::app {
namespace {

struct ActivityOutputs {
  std::optional<std::filesystem::path> chart, table, map;  // files
  bool prints_table = false;
};

ActivityOutputs outputs_of(const Options& options) {
  ActivityOutputs outputs{stated_output(options, "activity"), {}, {}};
  std::vector<std::string> inputs = input_files(options);
  if (outputs.chart) {
    constexpr std::uint32_t kColour = 3;
    check_picture_output(*outputs.chart, kColour, inputs, replacing(options));
    inputs.push_back(outputs.chart->string());  // no two outputs of one name either
  }
  if (options.map) {
    outputs.map = *options.map;
    check_picture_output(*outputs.map, 1, inputs, replacing(options));
    inputs.push_back(*options.map);
  }
  outputs.prints_table = options.csv == "-";
  if (options.csv && !outputs.prints_table) {
    outputs.table = *options.csv;
    check_output(*outputs.table, OutputKind::table, inputs, replacing(options));
  }
  if (outputs.prints_table && options.json)
    throw UsageError("--csv - and --json both go to standard output; use one");
  if (options.moment && *options.moment != "quietest" && *options.moment != "busiest")
    throw UsageError(format("--moment '{}' is neither quietest nor busiest", *options.moment));
  if (options.moment && (outputs.prints_table || options.json))
    throw UsageError("--moment prints nothing else; leave --csv - and --json away");
  return outputs;
}

ActivityRequest activity_request(const Options& options) {
  ActivityRequest request;
  if (options.has("tag") && !options.mask) throw UsageError("--tag is one of a mask; add -m mask.pgm");
  if (options.mask) request.mask = *options.mask;
  request.each_tag = options.each_tag;
  request.tag = options.tag;
  request.counts_redrawn = options.counts_redrawn;
  request.ignored_codes = options.by.value_or(request.ignored_codes);
  return request;
}

Json activity_json(const std::string& name, const MeasuredActivity& measured) {
  const Timeline& timeline = measured.timeline;
  const auto stretch_json = [&](const ActivityStretch& stretch, std::uint64_t pixels) {
    return Json{{"first_sample", stretch.samples.first},
                {"last_sample", stretch.samples.last - 1},
                {"start_ns", timeline.start_ns(stretch.samples.first)},
                {"end_ns", timeline.end_ns(stretch.samples.last - 1)},
                {"mean_changed_share", stretch.mean_share(pixels)}};
  };
  Json json{{"capture", name},
            {"duration_ns", timeline.duration_ns()},
            {"counted_pixels", measured.activity.pixel_count()}};
  const auto add_moments = [&](Json& to, const auto& moments, std::uint64_t pixels) {
    if (!moments) return;
    to.update({{"busiest_sample", moments->busiest_sample},
               {"busiest", stretch_json(moments->busiest, pixels)},
               {"quietest", stretch_json(moments->quietest, pixels)}});
  };
  add_moments(json, measured.moments, measured.activity.pixel_count());
  for (const TagActivity& each : measured.tags) {
    Json& tag = json["tags"].emplace_back(Json{{"tag", each.tag}, {"counted_pixels", each.pixel_count}});
    add_moments(tag, each.moments, each.pixel_count);
  }
  json["samples"] = Json::array();
  for (std::uint64_t k = 0; k < timeline.sample_count(); ++k) {
    json["samples"].push_back({{"sample", k},
                               {"start_ns", timeline.start_ns(k)},
                               {"end_ns", timeline.end_ns(k)},
                               {"changed_pixels", measured.activity.changed_pixels()[k]},
                               {"changed_share", measured.changed_share(k)},
                               {"redrawn", measured.is_redrawn(k)}});
  }
  return json;
}

// A stretch of the capture that this command saw, as words of another.
std::string stretch_words(const Options& options, const SampleRange& samples, const Timeline& timeline) {
  Options of_source = options;
  std::erase_if(of_source.said, [](const Said& said) { return said.option == "mask"; });  // it says what counts
  StatedTime start = stated_sample(samples.first, timeline);
  auto length = StatedTime::of_pictures(static_cast<std::int64_t>(samples.size()));
  if (timeline.pictures().sample_count() < timeline.sample_count()) {  // no pictures, of which some were made
    start = StatedTime::of_nanoseconds(timeline.start_ns(samples.first));
    length = StatedTime::of_nanoseconds(timeline.end_ns(samples.last - 1) - timeline.start_ns(samples.first));
  }
  return format("{} --start {} --exposure {}", stated_words(of_source, CommandId::expose), start.text(), length.text());
}

void report_text(const Options& options, const MeasuredActivity& measured) {
  const std::string& name = options.operands.front();
  const Timeline& timeline = measured.timeline;
  print_line(format("{}: {} samples in {}, {:.3g} % of {} pixels change at a sample, on average", name,
                    timeline.sample_count(), duration_text(timeline.duration_ns()),
                    100 * measured.mean_share(), measured.activity.pixel_count()));
  if (!measured.moments) {
    print_line(measured.is_still() ? "  nothing changes" : "  too short to tell where it is quiet");
    return;
  }
  const auto& [busiest_sample, busiest, quietest] = *measured.moments;
  const auto stated = [&](std::uint64_t sample) { return stated_sample(sample, timeline).text(); };
  print_line(format("  most at once  {} ({}), {:.3g} %", duration_text(timeline.start_ns(busiest_sample)),
                    stated(busiest_sample), 100 * measured.changed_share(busiest_sample)));
  for (const auto& [what, stretch] : {std::pair("busiest ", busiest), std::pair("quietest", quietest)}) {
    const std::uint64_t first = stretch.samples.first, last = stretch.samples.last - 1;
    print_line(format("  {}      {} to {} ({} to {}), {:.3g} % of pixels change at a sample", what,
                      duration_text(timeline.start_ns(first)), duration_text(timeline.reach_end_ns(last)),
                      stated(first), stated(last), 100 * stretch.mean_share(measured.activity.pixel_count())));
  }
  for (const TagActivity& each : measured.tags) {
    const SampleRange quiet = measured.moment(name, true, each);
    print_line(format("  M{}: {}, quietest {} to {}", each.tag, counted(each.pixel_count, "pixel"),
                      stated(quiet.first), stated(quiet.last - 1)));
  }
  print_line(format("try: nutik-cl{} {} quiet.png", stretch_words(options, quietest.samples, timeline),
                    shell_word(name)));
}

// The stretches that --moment asks for, as options of another command: of all pixels, or a line for each tag.
std::string moments_text(const Options& options, const MeasuredActivity& measured) {
  const std::string& name = options.operands.front();
  const bool quietest = *options.moment == "quietest";
  const auto words = [&](const SampleRange& samples) { return stretch_words(options, samples, measured.timeline); };
  if (measured.tags.empty()) return words(measured.moment(name, quietest)).substr(1);
  std::vector<std::string> lines;
  for (const TagActivity& each : measured.tags)
    lines.push_back(format("--tag {}{}", each.tag, words(measured.moment(name, quietest, each))));
  return joined(lines, "\n");
}

}  // namespace

int run_activity(const Options& options) {
  const ActivityOutputs outputs = outputs_of(options);
  const ActivityRequest request = activity_request(options);
  const std::string& name = options.operands.front();
  Session session =
      open_session(name, options, make_devices(options), {.besides = Activity::needs, .renders = false});
  const auto measured = measure_activity(session, request, progress_bar("counting", options.quiet));
  const Activity& activity = measured.activity;

  if (outputs.chart) {
    write_picture(*outputs.chart,
                  sheet::activity_chart(std::filesystem::path(name).filename().string(), measured.timeline,
                                        activity.changed_pixels(), activity.pixel_count(), measured.moments));
  }
  if (outputs.map)
    write_picture(*outputs.map, sheet::activity_map(session.format().shape, activity.changes()));
  if (outputs.table) write_text(*outputs.table, measured.table());
  Answer answer;
  if (options.moment) {
    print_line(moments_text(options, measured));
  } else if (outputs.prints_table) {
    print_text(measured.table());
  } else if (options.json) {
    answer.json = activity_json(name, measured);
  } else if (!options.quiet) {
    report_text(options, measured);
  }
  answer.tell_source(session);
  for (std::string& note : note_texts(measured.notes(), Dialect::command_line)) answer.notes.push_back(std::move(note));
  if (measured.moments && measured.mean_share() > 0.5) {
    answer.notes.emplace_back(
        "most pixels change at every sample, as noise does; --by CODES counts larger changes only");
  }
  return tell(options, name, answer, true);
}

}  // namespace nutik::app
