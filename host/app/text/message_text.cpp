#include "app/text/message_text.hpp"

#include <vector>

#include "app/command_line/suggestion.hpp"
#include "session/below/capture.hpp"
#include "session/below/format.hpp"
#include "session/clips/alignment.hpp"
#include "session/clips/clip_source.hpp"
#include "session/clips/measured_noise.hpp"
#include "session/devices.hpp"
#include "session/making/mask_making.hpp"
#include "session/making/picture_recipe.hpp"
#include "session/making/study_request.hpp"
#include "session/memory_budget.hpp"
#include "session/output_check.hpp"
#include "session/requests/contact_request.hpp"
#include "session/requests/output_request.hpp"
#include "session/requests/picture_input.hpp"
#include "session/requests/series_request.hpp"
#include "session/text/shell_text.hpp"

namespace nutik::app {
namespace {

// `\ndid you mean oclgrind?`. Case does not count in a device's name.
std::string device_suggestion(const DeviceNotFound& error) {
  if (error.wanted.size() < 3) return {};
  const std::string suggestion = did_you_mean(lower_case(error.wanted), error.words());
  return suggestion.empty() ? std::string() : "\n" + suggestion.substr(2);
}

}  // namespace

std::string_view option_of(Setting setting) {
  switch (setting) {
    case Setting::automatic_noise: return "--noise auto";
    case Setting::block_samples: return "--block-samples";
    case Setting::chroma_place: return "--chroma-at";
    case Setting::columns: return "--columns";
    case Setting::contrast: return "--contrast";
    case Setting::count_redrawn: return "--count-redrawn";
    case Setting::crop: return "--crop";
    case Setting::deflicker: return "--deflicker";
    case Setting::deinterlace: return "--deinterlace";
    case Setting::depth: return "--depth";
    case Setting::end_at_damage: return "--as-far-as-it-goes";
    case Setting::frame_rate: return "--fps";
    case Setting::from: return "--from";
    case Setting::matrix: return "--matrix";
    case Setting::normalization: return "--normalize";
    case Setting::out_transfer: return "--out-transfer";
    case Setting::pixel_aspect: return "--pixel-aspect";
    case Setting::precision: return "--precision";
    case Setting::primaries: return "--primaries";
    case Setting::quality: return "--quality";
    case Setting::range: return "--range";
    case Setting::raw_layout: return "--raw";
    case Setting::renderer: return "--renderer";
    case Setting::scale: return "--scale";
    case Setting::shutter_angle: return "--shutter-angle";
    case Setting::start_picture: return "--start-picture";
    case Setting::tick: return "--tick";
    case Setting::to: return "--to";
    case Setting::transfer: return "--transfer";
    case Setting::unmapped: return "--unmapped zero";
    case Setting::video_codec: return "--video-codec";
    case Setting::white_code: return "--white";
    case Setting::width: return "--width";
  }
  return {};
}

std::string options_text(const std::vector<Setting>& settings) {
  std::string text;
  for (const Setting setting : settings)
    text += format("{}{}", text.empty() ? " (" : ", ", option_of(setting));
  return text.empty() ? text : text + ")";
}

std::string message_text(const std::exception& error) {
  const std::string message = error.what();
  if (const auto* memory = dynamic_cast<const MemoryTooLittle*>(&error)) {
    return format("{}; allow more: --memory {}MB", message, memory->min_bytes() / 1'000'000 + 1);
  }
  if (const auto* blocks = dynamic_cast<const BlocksTooLong*>(&error)) {
    return format("{} (--memory); use fewer samples a block (--block-samples {})", message,
                  blocks->max_samples);
  }
  if (const auto* damaged = dynamic_cast<const tik::Recoverable*>(&error)) {
    return format("{}; save what is whole with: nutik-cl recover {} -o recovered.tik", message,
                  shell_word(damaged->name));
  }
  if (dynamic_cast<const ExposuresAreListed*>(&error) != nullptr) {
    return message + "; leave --shutter-angle out, or the exposure_ns column empty";
  }
  if (const auto* align = dynamic_cast<const CannotAlign*>(&error)) {
    if (align->way_out == CannotAlign::WayOut::hold)
      return message + "; take a part of the clip (--from, --to), or keep the picture's size (--unseen hold)";
    return format("{}; try {}another picture to align to (--align-to), or a part of the clip (--from, --to)",
                  message, align->way_out == CannotAlign::WayOut::homography ? "--align homography, " : "");
  }
  if (const auto* moves = dynamic_cast<const FootageMoves*>(&error)) {
    const char* first = "";
    switch (moves->way_out) {
      case FootageMoves::WayOut::align: first = "an aligned camera (--align rigid), "; break;
      case FootageMoves::WayOut::deflicker: first = "evened brightness (--deflicker), "; break;
      case FootageMoves::WayOut::part: break;
    }
    return format("{}; or {}a part that stands still (--crop, --from, --to)", message, first);
  }
  if (dynamic_cast<const EverythingMoves*>(&error) != nullptr) {
    return message + ". A camera that moved stands still with --align rigid";
  }
  if (dynamic_cast<const SeriesTooLong*>(&error) != nullptr) return message + "; say how many with --count";
  if (const auto* series = dynamic_cast<const SeriesBehindEnd*>(&error)) {
    return format("{}; --count {} at most", message, series->possible_count);
  }
  if (dynamic_cast<const NothingInCapture*>(&error) != nullptr) {
    return message + "; --count 1 makes one that goes on behind its end";
  }
  if (const auto* sheet = dynamic_cast<const TooManyForSheet*>(&error)) {
    return format("--every {}; take --every {} or more, or begin later with --start", message,
                  sheet->min_every.text());
  }
  if (dynamic_cast<const NoMaskSize*>(&error) != nullptr) return message + ", or say --size 640x360";
  if (dynamic_cast<const NoSinglePicture*>(&error) != nullptr) {
    return message + ", or a time of the capture: 0.3s, 12f";
  }
  if (const auto* device = dynamic_cast<const DeviceNotFound*>(&error))
    return message + device_suggestion(*device);
  if (dynamic_cast<const SeveralDevices*>(&error) != nullptr) return message + ": --device 0";
  if (const auto* name = dynamic_cast<const WrongOutputName*>(&error)) {
    return message + (name->kind == OutputKind::tik ? ": encode writes .tik files (nutik-cl CLIP CAPTURE.tik)"
                                                    : ", or as - to standard output");
  }
  if (dynamic_cast<const OutputIsThere*>(&error) != nullptr)
    return message + "; choose another name, or replace it with --overwrite";
  if (dynamic_cast<const RecipeTooLong*>(&error) != nullptr) return message + "; leave it out: --no-recipe";
  if (const auto* light = dynamic_cast<const LightIsKept*>(&error)) {
    return format(
        "--negative says what codes make of light below 0, and {} holds floating point, which keeps it; "
        "leave --negative out",
        light->output.string());
  }
  if (const auto* known = dynamic_cast<const Error*>(&error))
    return message + options_text(known->settings());
  return message;
}

std::vector<std::string> note_texts(const std::vector<Note>& notes) {
  std::vector<std::string> texts;
  for (const Note& note : notes) texts.push_back(note.text + options_text(note.settings));
  return texts;
}

}  // namespace nutik::app
