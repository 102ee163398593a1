#include "app/command_line/command_table.hpp"

#include <algorithm>
#include <iterator>

#include "system/is_absent.hpp"

namespace nutik::app {

// In app/commands; completion and man beside this file.
Run run_activity, run_background, run_batch, run_check, run_completion, run_contact, run_devices, run_encode,
    run_expose, run_info, run_join, run_man, run_mask, run_noise, run_recover, run_reproduce, run_retime, run_shutter,
    run_solve, run_study, run_sweep, run_thumbnail, run_trace, run_validate, run_video;

namespace {

using Id = CommandId;

constexpr Command kCommands[] = {
    {Id::encode, "encode", "CLIP [CAPTURE.tik]",
     "Turn a video or a sequence of stills into a .tik capture: for every pixel, a record of each change of "
     "its value.",
     "nutik-cl clip.mp4 clip.tik\n"
     "nutik-cl -f 960 -a 180 slowmotion.mp4 clip.tik\n"
     "nutik-cl encode --tolerance 4 -o small.tik clip.mp4\n"
     "nutik-cl -f 30000 --white 4095 'frames/*.png' capture.tik\n"
     "nutik-cl -f 500 frame%04d.tif capture.tik\n"
     "nutik-cl encode --align rigid --camera-path path.csv clip.mp4 still.tik\n"
     "nutik-cl encode --from 0.5s --to 1s clip.mp4 part.tik",
     run_encode, kCaptures},
    {Id::expose, "expose", "CAPTURE.tik|CLIP [PICTURE]",
     "Expose a picture: each pixel is the integral of its light times a gain function of time.",
     "nutik-cl --start 0.4s --exposure 10ms clip.tik moment.png\n"
     "nutik-cl --start 0.4s --exposure 10ms --shutter hann --normalize integral clip.tik soft.png\n"
     "nutik-cl --start 0s --exposure 10ms --every 40ms --count 10 clip.tik -o out-%03d.png\n"
     "nutik-cl -k trail.fn clip.tik trail.png\n"
     "nutik-cl -m regions.pgm -k regions.fn clip.tik picture.tif --depth 16\n"
     "nutik-cl -m regions.pgm -k difference.fn clip.tik -o light.pfm",
     run_expose, kPictures},
    {Id::info, "info", "CAPTURE.tik", "Say what a capture holds.",
     "nutik-cl info clip.tik\n"
     "nutik-cl info --activity map.png clip.tik",
     run_info, kCaptures},
    {Id::devices, "devices", "", "List the OpenCL devices that --device can choose from.", "nutik-cl devices",
     run_devices},
    {Id::recover, "recover", "DAMAGED.tik WHOLE.tik",
     "Save the whole blocks of a .tik file that was cut off.", "nutik-cl recover damaged.tik -o whole.tik",
     run_recover, kCaptures},
    {Id::join, "join", "PART.tik... -o WHOLE.tik",
     "Make one capture of a clip's parts: of those that encode --from --to made, on several machines perhaps.",
     "nutik-cl join part-1.tik part-2.tik part-3.tik -o whole.tik\n"
     "nutik-cl join part-*.tik -o whole.tik",
     run_join, kCaptures},
    {Id::thumbnail, "thumbnail", "CAPTURE.tik [PICTURE.png]",
     "Write a capture's first sample as a small picture (for file managers).",
     "nutik-cl thumbnail clip.tik\n"
     "nutik-cl thumbnail --width 512 clip.tik first.png",
     run_thumbnail, kCaptures},
    {Id::retime, "retime", "CAPTURE.tik [CORRECTED.tik]",
     "Correct what a capture says of itself: rate, shutter angle, transfer function, primaries, pixel aspect, without "
     "encoding its clip again. With --in-place the capture itself is replaced.",
     "nutik-cl retime clip.tik -f 960 -a 180 --in-place\n"
     "nutik-cl retime clip.tik --transfer linear -o corrected.tik",
     run_retime, kCaptures},
    {Id::noise, "noise", "CLIP... [-o CAMERA.noise]",
     "Measure a camera's noise on footage of a still scene: one clip, or several exposures of it. The file "
     "is text; NoisePlotter.py draws it, --noise encodes with it.",
     "nutik-cl noise still-scene.mp4 -o camera.noise\n"
     "nutik-cl noise --white 4095 dark/ middle/ bright/ -o deep.noise\n"
     "nutik-cl encode --noise camera.noise clip.mp4 clip.tik",
     run_noise, kCaptures},
    {Id::batch, "batch", "LIST.txt [CAPTURE.tik|CLIP]",
     "Expose many pictures: each line of the list is an exposure's options and its picture. The capture is "
     "read once; what cannot be exposed is reported and left out.",
     "nutik-cl batch exposures.txt clip.tik\n"
     "printf '%s\\n' '--start 0s --exposure 10ms a.png' '-k trail.fn b.png' | nutik-cl batch - clip.tik",
     run_batch, kPictures},
    {Id::check, "check", "[CAPTURE.tik|CLIP]",
     "Name what is wrong or suspicious in functions, masks, captures (and tell each function's figures).",
     "nutik-cl check -k regions.fn\n"
     "nutik-cl check -m regions.pgm -k regions.fn clip.tik\n"
     "nutik-cl check --json -m regions.pgm -k regions.fn clip.tik\n"
     "nutik-cl check --points -k regions.fn",
     run_check, kUnderstanding},
    {Id::trace, "trace", "CAPTURE.tik|CLIP [TRACE.csv|TRACE.png]",
     "Follow one pixel, or the mean of a region, through an exposure: its light, the gain, and what they add "
     "from edge to edge.",
     "nutik-cl trace --pixel 320,180 -k trail.fn clip.tik\n"
     "nutik-cl trace --pixel 320,180 -m regions.pgm -k regions.fn clip.tik trace.png\n"
     "nutik-cl trace --tag 128 -m regions.pgm -k regions.fn clip.tik -o trace.csv\n"
     "nutik-cl trace --pixel 0,0 --start 0.4s --exposure 10ms clip.tik",
     run_trace, kUnderstanding},
    {Id::mask, "mask", "[CAPTURE.tik|CLIP] [MASK.pgm]",
     "Make a mask from shapes, pictures and motion (no image editor is needed).",
     "nutik-cl mask --moving clip.tik mask.pgm --preview preview.png\n"
     "nutik-cl mask --moving --smooth 2 --largest --grow 4 clip.tik mask.pgm\n"
     "nutik-cl mask --tag 128 --changed-between 0.3s 0.5s --tag 255 --ellipse 320,180,60,40 clip.tik\n"
     "nutik-cl mask --difference empty.png full.png --by 24 -o mask.pgm\n"
     "nutik-cl mask --size 640x360 --tag 64 --rectangle 0,0,320,360 -o halves.pgm",
     run_mask, kUnderstanding},
    {Id::contact, "contact", "CAPTURE.tik|CLIP [SHEET.png]",
     "Lay out exposures, one after another, on a labelled sheet: to find the moment.",
     "nutik-cl contact clip.tik\n"
     "nutik-cl contact --every 0.2s --exposure 10ms clip.tik sheet.png\n"
     "nutik-cl contact --start 0.4s --every 5f --columns 6 --width 2400 clip.tik -o sheet.png",
     run_contact, kUnderstanding},
    {Id::activity, "activity", "CAPTURE.tik|CLIP [CHART.png]",
     "Say when a capture changes and when it is quiet: as text, table, chart and map.",
     "nutik-cl activity clip.tik\n"
     "nutik-cl activity --csv activity.csv --map where.png clip.tik chart.png\n"
     "nutik-cl activity -m mask.pgm --tag 128 --csv - clip.tik",
     run_activity, kUnderstanding},
    {Id::sweep, "sweep", "CAPTURE.tik|CLIP [SHEET.png]",
     "Expose with the same functions again and again: each time later, stronger or longer, on a labelled "
     "sheet.",
     "nutik-cl sweep -k file.fn -m mask.pgm --shift 0..1s/0.1s clip.tik\n"
     "nutik-cl sweep -k trail.fn --scale-gain 0.5..2/0.25 --stretch 0.5..2/0.5 clip.tik sheet.png\n"
     "nutik-cl sweep --start 0.4s --exposure 10ms --shift 0..40f/5f --each moment-%02d.png clip.tik",
     run_sweep, kUnderstanding},
    {Id::video, "video", "CAPTURE.tik|CLIP [VIDEO]",
     "Film the scene again: a video of any frame rate and shutter angle, each frame an exposure of its own "
     "interval.",
     "nutik-cl video clip.tik film.mp4\n"
     "nutik-cl video --out-fps 24 --out-angle 180 --from 0.2s --to 1s --speed 0.25 clip.tik slow.mp4\n"
     "nutik-cl video -f 960 --out-fps 30000/1001 --out-angle 360 slowmotion.mp4 film.mkv\n"
     "nutik-cl video --depth 16 clip.tik frame-%05d.png\n"
     "nutik-cl video -k trail.fn --out-fps 25 clip.tik trail.mp4\n"
     "nutik-cl video --curve ramp.csv clip.tik ramp.mp4\n"
     "nutik-cl video --key 0s sharp.fn --key 0.2s trail.fn clip.tik change.mp4",
     run_video, kPictures},
    {Id::study, "study", "CAPTURE.tik|CLIP [PICTURE]",
     "Make a motion study by itself: find what moves, choose moments of it, and expose them over its trail. Mask, "
     "functions and commands are written beside the picture, to be changed by hand.",
     "nutik-cl study clip.mp4\n"
     "nutik-cl study --style strobe --moments 7 --spacing distance clip.tik strobe.png\n"
     "nutik-cl study --moments 0.36s,0.75s,1.27s --trail ramp clip.tik study.png",
     run_study, kPictures},
    {Id::solve, "solve", "CAPTURE.tik|CLIP [FUNCTIONS.fn]",
     "Find the gains and times that make a picture as it is wished: in a function file, what is to be found has a name "
     "in place of its number, as in M0 [0:1], [1000000000:1], [1000000001:rest], [1010000000:rest], [1010000001:0].",
     "nutik-cl solve -k named.fn --free rest=-50..0 --wish '300,150,60,60 gone at 0s' clip.tik solved.fn\n"
     "nutik-cl solve -m regions.pgm -k named-regions.fn --free rest=-50..0 --wish 'M0 = background' clip.tik\n"
     "nutik-cl solve -k moved.fn --free when=0.2s..0.8s/1f --wish '300,150,60,60 >= 1.2 * background' clip.tik",
     run_solve, kUnderstanding},
    {Id::background, "background", "CAPTURE.tik|CLIP [PICTURE.png]",
     "Show the scene without moving things: each pixel's light that it holds longest.",
     "nutik-cl background clip.tik\n"
     "nutik-cl background --uncertain unsure.pgm clip.mp4 empty.png\n"
     "nutik-cl background --depth float clip.tik -o empty.pfm",
     run_background, kPictures, "plate"},
    {Id::shutter, "shutter", "SHAPE [CAPTURE.tik|CLIP]",
     "Write a shutter's shape as a gain function: a line for a function file. Shapes: box, trapezoid:R, "
     "triangle, gaussian, hann, strobe:N[,R], spline:0=G,…,1=G. Times that count pictures (32f) are those of "
     "the capture.",
     "nutik-cl shutter hann --start 0.4s --exposure 10ms --tag 128 > f.fn\n"
     "nutik-cl shutter box --start 32f --exposure 1f clip.tik > picture-32.fn\n"
     "nutik-cl shutter spline:0=0,0.1=1,1=0 --exposure 1s > trail.fn\n"
     "nutik-cl shutter strobe:5 --start 30f --exposure 60f --fps 960",
     run_shutter, kUnderstanding},
    {Id::reproduce, "reproduce", "PICTURE [FOLDER...]",
     "Print the command that makes a picture again: byte for byte, from the recipe that the picture carries. The "
     "files it was made from are looked for in the folders, the current one and the picture's.",
     "nutik-cl reproduce picture.png\n"
     "nutik-cl reproduce picture.png captures masks\n"
     "nutik-cl reproduce picture.png | sh",
     run_reproduce, kPictures, "again"},
    {Id::completion, "completion", "bash|zsh|fish",
     "Print a script for completion in a shell: of commands, options and their values. cmake --install puts all "
     "three where shells look for them.",
     "source <(nutik-cl completion bash)\n"
     "nutik-cl completion fish > nutik-cl.fish",
     run_completion},
    {Id::man, "man", "", "Print the manual page. cmake --install puts it where man looks for it.",
     "nutik-cl man > nutik-cl.1\n"
     "nutik-cl man | man -l -",
     run_man},
    {Id::validate, "validate", "CAPTURE.tik|CLIP",
     "Expose in every arithmetic and with the reference: how right each is, within which bound, and how long it "
     "takes. Exit status 1 if one exceeds its bound.",
     "nutik-cl validate --start 0.4s --exposure 10ms clip.tik\n"
     "nutik-cl validate -m regions.pgm -k regions.fn --depth 16 clip.tik\n"
     "nutik-cl validate --start 0s --exposure 1s --source clip.mp4 clip.tik\n"
     "nutik-cl validate --json --runs 20 -k trail.fn clip.tik",
     run_validate, kUnderstanding},
};

template <typename Wanted>
const Command* first_command(Wanted wanted) {
  const auto found = std::ranges::find_if(kCommands, wanted);
  return found == std::end(kCommands) ? nullptr : &*found;
}

}  // namespace

std::span<const Command> commands() { return kCommands; }

std::vector<const Command*> commands_of(std::string_view group) {
  std::vector<const Command*> found;
  for (const Command& entry : commands()) {
    if (entry.group == group) found.push_back(&entry);
  }
  return found;
}

const Command& command(CommandId id) {
  return *first_command([&](const Command& entry) { return entry.id == id; });
}

const Command* find_command(std::string_view name) {
  return first_command([&](const Command& entry) {
    return entry.name == name || (entry.old_name == name && !name.empty() && is_absent(name));
  });
}

}  // namespace nutik::app
