#include "features/plate/plate.hpp"

#include <algorithm>
#include <iterator>

#include "app/output/output_name.hpp"
#include "app/output/progress.hpp"
#include "app/output/report.hpp"
#include "app/words/stated_requests.hpp"
#include "capture/format.hpp"
#include "features/schema/options.hpp"
#include "media/writers/picture_writer.hpp"
#include "scene/shots.hpp"
#include "session/text/number_text.hpp"

namespace nutik::app {
namespace {

MemoryNeeds plate_needs(const CaptureFormat& capture) {
  MemoryNeeds needs = plate_making_needs(capture);
  needs.add(camera_check_needs(capture));
  return needs;
}

}  // namespace

int run_background(const Options& options) {
  const Stopwatch stopwatch;
  const std::filesystem::path output = output_name(options, "background", "-background.png");
  std::vector<std::string> inputs = input_files(options);
  check_output(output, OutputKind::picture, inputs, replacing(options));
  if (options.uncertain) {
    inputs.push_back(output.string());
    check_mask_output(*options.uncertain, inputs, replacing(options));
  }
  PlateRequest request;
  request.by_codes = options.by;

  Session session = open_session(options, {.besides = plate_needs, .renders = false});
  const CaptureFormat& capture = session.format();
  const MadePlate made =
      make_plate(session.capture(), options.operands.front(), request,
                 output_format(options.picture, output, capture), session.devices().request().memory,
                 progress_bar("reading", options.quiet));
  if (!made.is_noise_known) {
    print_warning(
        "nothing in the capture is still for long enough to tell its noise: codes that differ by up to "
        "1/32 of white were taken for the same light; --by CODES states another difference");
  }
  // Before anything is written: what cannot be looked at is an error.
  const auto moved = moved_camera(session.capture());
  write_picture(output, made.picture, {}, file_wishes(options.picture));
  if (options.uncertain) {
    Mask mask = Mask::uniform(capture.shape.width, capture.shape.height, 0);
    paint(mask, made.uncertain, 255);
    write_picture(*options.uncertain, mask.to_picture());
  }

  const std::uint64_t uncertain = made.uncertain.pixel_count();
  Answer answer{{{"picture", output.string()}}};
  const Shape shape =
      written_shape(output, made.picture.shape, made.picture.pixel_aspect, file_wishes(options.picture));
  answer.json.update(shape_json(shape));
  answer.json.update({{"samples", session.timeline().sample_count()},
                      {"uncertain_pixels", uncertain},
                      {"seconds", stopwatch.seconds()}});
  answer.line =
      format("{}: {}, {} samples, {} of the pixels uncertain, {:.2f} s", output.string(), shape_text(shape),
             session.timeline().sample_count(), percent_text(uncertain, capture.shape.pixel_count()),
             stopwatch.seconds());
  answer.notes = square_notes(capture, shape);
  // Every picture is looked at for this, which would take long where nothing is wrong.
  if (2 * uncertain > capture.shape.pixel_count()) {
    if (const auto shots = shots_of(session.capture()); shots.size() > 1) {
      const auto& from = options.source.clip.from;
      const std::uint64_t part = from && from->is_picture ? static_cast<std::uint64_t>(from->value) : 0;
      answer.notes.push_back(format("there are {} shots, which begin at pictures {}{}, and the background is of all of "
                                    "them{}",
                                    shots.size(), starts_of(shots, part), from && part == 0 ? " of that part" : "",
                                    session.is_clip() ? ": take one (--from, --to)" : ""));
    }
  }
  std::ranges::move(camera_notes(moved), std::back_inserter(answer.notes));
  answer.tell_source(session);
  if (made.saturation.above > 0) {
    answer.notes.push_back(
        format("{} hold more light than white and come out white; an .exr or a .tif with --depth float "
               "keeps it",
               counted(made.saturation.above, "pixel")));
  }
  return tell(options, output, answer);
}

}  // namespace nutik::app
