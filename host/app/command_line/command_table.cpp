#include "app/command_line/command_table.hpp"

#include <algorithm>
#include <vector>

#include "app/commands/commands.hpp"

namespace nutik::app {

std::span<const Command> commands() {
  using Id = CommandId;
  static const std::vector<Command> table{
      {Id::encode, "encode", "CLIP [CAPTURE.tik]",
       "Turn a video or a sequence of stills into a .tik capture: for every pixel, a record of each change "
       "of its value.",
       "nutik-cl clip.mp4 clip.tik\n"
       "nutik-cl -f 960 -a 180 slowmotion.mp4 clip.tik\n"
       "nutik-cl encode --tolerance 4 -o small.tik clip.mp4\n"
       "nutik-cl -f 30000 --white 4095 'frames/*.png' capture.tik\n"
       "nutik-cl -f 500 frame%04d.tif capture.tik",
       run_encode},
      {Id::expose, "expose", "CAPTURE.tik|CLIP [PICTURE]",
       "Expose a picture: each pixel is the integral of its light times a gain function of time.",
       "nutik-cl --start 0.4s --exposure 10ms clip.tik moment.png\n"
       "nutik-cl -k trail.fn clip.tik trail.png\n"
       "nutik-cl -m regions.pgm -k regions.fn clip.tik picture.tif --depth 16\n"
       "nutik-cl -m regions.pgm -k difference.fn clip.tik -o light.pfm",
       run_expose},
      {Id::info, "info", "CAPTURE.tik", "Say what a capture holds.",
       "nutik-cl info clip.tik\n"
       "nutik-cl info --activity map.png clip.tik",
       run_info},
      {Id::devices, "devices", "", "List the OpenCL devices that --device can choose from.",
       "nutik-cl devices", run_devices},
      {Id::recover, "recover", "DAMAGED.tik WHOLE.tik",
       "Save the whole blocks of a .tik file that was cut off.", "nutik-cl recover damaged.tik -o whole.tik",
       run_recover},
      {Id::noise, "noise", "CLIP... [-o CAMERA.noise]",
       "Measure a camera's noise on footage of a still scene: one clip, or several exposures of it. The file "
       "is text; tools/NoisePlotter.py draws it, --noise encodes with it.",
       "nutik-cl noise still-scene.mp4 -o camera.noise\n"
       "nutik-cl noise --white 4095 dark/ middle/ bright/ -o camera.noise\n"
       "nutik-cl encode --noise camera.noise clip.mp4 clip.tik",
       run_noise},
      {Id::batch, "batch", "LIST.txt [CAPTURE.tik|CLIP]",
       "Expose many pictures: each line of the list is an exposure's options and its picture. The capture is "
       "read once; what cannot be exposed is reported and left out.",
       "nutik-cl batch exposures.txt clip.tik\n"
       "printf '%s\\n' '--start 0s --exposure 10ms a.png' '-k trail.fn b.png' | nutik-cl batch - clip.tik",
       run_batch},
  };
  return table;
}

const Command& command(CommandId id) {
  return *std::find_if(commands().begin(), commands().end(),
                       [&](const Command& entry) { return entry.id == id; });
}

const Command* find_command(std::string_view name) {
  const auto found = std::find_if(commands().begin(), commands().end(),
                                  [&](const Command& entry) { return entry.name == name; });
  return found == commands().end() ? nullptr : &*found;
}

}  // namespace nutik::app
