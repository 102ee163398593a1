#include "features/schema/option.hpp"
#include "features/schema/taking.hpp"
#include "features/series/series_request.hpp"
#include "plot/canvas.hpp"

namespace nutik {
namespace {

using Id = CommandId;
using enum Scope;

constexpr CommandSet kAll = ~CommandSet{0};
// Those that open a clip, or a capture in its place, and so take what describes it.
constexpr CommandSet kOpensClips =
    set_of(Id::encode, Id::expose, Id::batch, Id::check, Id::trace, Id::mask, Id::contact, Id::activity,
           Id::sweep, Id::video, Id::validate, Id::background, Id::study, Id::solve);
// Those and the one that measures a clip's noise, and so take what its codes are.
constexpr CommandSet kOpensClipsOrNoise = kOpensClips | bit(Id::noise);
// Those that make a capture of it, in a file or in memory: what is kept of a clip is theirs to state.
constexpr CommandSet kBuildsCaptures = kOpensClips & ~bit(Id::check);
// Those that take gain functions.
constexpr CommandSet kTakesFunctions =
    set_of(Id::expose, Id::check, Id::trace, Id::sweep, Id::video, Id::validate, Id::solve);
// Those that take a plain interval.
constexpr CommandSet kTakesIntervals =
    set_of(Id::expose, Id::trace, Id::mask, Id::contact, Id::sweep, Id::validate, Id::shutter);
// Those that take a mask between two.
constexpr CommandSet kBlendsMasks = set_of(Id::expose, Id::check, Id::trace, Id::validate);
// Those that shape and weigh what they expose.
constexpr CommandSet kShapesExposures = kTakesFunctions & ~set_of(Id::check, Id::solve);
// Those that expose pictures, and so take what says how that is computed.
constexpr CommandSet kExposes =
    set_of(Id::expose, Id::batch, Id::mask, Id::contact, Id::sweep, Id::video, Id::study, Id::solve);
// Those whose pictures may hold light below 0.
constexpr CommandSet kExposesFreely = set_of(Id::expose, Id::contact, Id::sweep, Id::video);
// Those that make many pictures, each in a file of its own.
constexpr CommandSet kMakesMany = set_of(Id::expose, Id::batch, Id::video);
// Those that write files.
constexpr CommandSet kWrites =
    (kOpensClips & ~set_of(Id::check, Id::validate)) |
    set_of(Id::recover, Id::noise, Id::retime, Id::join, Id::info, Id::thumbnail);
// Those that lay pictures out on a sheet.
constexpr CommandSet kMakesSheets = set_of(Id::contact, Id::sweep);
// Without --json: they print the result itself.
constexpr CommandSet kOnlyPrints = set_of(Id::shutter, Id::reproduce, Id::completion, Id::man);

// A heading in help, for the rows after it.
constexpr Option heading(std::string_view title) { return {.heading = title}; }

// A row that errors and notes refer to, and its argument's name in Python where that is another.
constexpr Option known(Setting setting, Option row) {
  row.setting = setting;
  return row;
}
constexpr Option known(Setting setting, std::string_view python, Option row) {
  row.python = python;
  return known(setting, row);
}

// A row that had another name in earlier versions.
constexpr Option formerly(std::string_view old_name, Option row) {
  row.old_name = old_name;
  return row;
}

// A row that may be given again and again, and is kept in the order of the command line: the steps of a mask, and
// others.
constexpr Option repeated(std::string_view name, std::string_view value, std::string_view help, Id of = Id::mask,
                          Scope scope = subject) {
  return {0, name, value, scope, bit(of), {}, help};
}

constexpr Option kRows[] = {
    heading(kSourceClip),
    known(Setting::frame_rate, "rate", {'f', "fps", "RATE", timing, kOpensClips | set_of(Id::shutter, Id::retime),
     take<InClip<&ClipOptions::rate>>,
     "pictures a second that the clip was filmed with: 120, 29.97, 30000/1001 (default: what the file says)"}),
    known(Setting::shutter_angle, {'a', "shutter-angle", "DEGREES", timing, kOpensClips | set_of(Id::shutter,
     Id::retime),
     take<InSource<&SourceRequest::shutter_angle>>,
     "how long the shutter was open: 360 is all the time to the next picture (default: what the file says, else "
     "360)"}),
    known(Setting::from, "begin", {0, "from", "TIME", decoding, kOpensClipsOrNoise & ~bit(Id::video),
     take_by<InClip<&ClipOptions::from>, parse_clip_moment>,
     "take pictures that start here or later: 1.5s, 32f; the first of them is at time 0 (default: all)"}),
    known(Setting::to, "end", {0, "to", "TIME", decoding, kOpensClipsOrNoise & ~bit(Id::video),
     take_by<InClip<&ClipOptions::to>, parse_clip_moment>,
     "take pictures that start earlier: 2s, 48f (default: all)"}),
    known(Setting::crop, {0, "crop", "WxH+X+Y", decoding, kOpensClipsOrNoise,
     take_by<InClip<&ClipOptions::crop>, parse_crop>,
     "take a rectangle of the clip's pictures: its size, and the place of its top left pixel"}),
    known(Setting::scale, {0, "scale", "SCALE", decoding, kOpensClipsOrNoise,
     take_by<InClip<&ClipOptions::scale>, parse_scale>,
     "make pictures smaller: each pixel is the mean of the light it covers, 1/2, 1/3, …, or 640x360"}),
    known(Setting::deinterlace, {0, "deinterlace", "HOW", decoding, kOpensClipsOrNoise,
     take_choice<InClip<&ClipOptions::interlaced>, Interlaced::frames, Interlaced::fields, Interlaced::ignored>,
     "what becomes of interlaced video: frames (a picture from each frame), fields (one from each field, twice as"
     " many), or no (it only says that it is) (default: it is refused)",
     "frames fields no"}),
    known(Setting::deflicker, {0, "deflicker", "", decoding, kOpensClips, take<InSource<&SourceRequest::deflickered>>,
     "expose all pictures as the first one: undo a camera's automatic exposure and white balance"}),
    known(Setting::between, {0, "between", "HOW", encoding, kBuildsCaptures,
     take_by<InSource<&SourceRequest::between>, parse_between>,
     "make samples between pictures, along the motion: auto (as many as no step is longer than about a pixel, "
     "none where nothing moves), or how many, 1 … 63; auto:10f..20f, between these pictures alone; the clip is read "
     "twice (default: off; a study makes them where its trail has gaps, a video where its frames mix pictures)",
     "auto auto: off"}),
    formerly("as-far-as-it-goes", known(Setting::end_at_damage, {0, "ignore-errors", "", decoding, kOpensClipsOrNoise,
     take<InClip<&ClipOptions::ends_at_damage>>,
     "take a damaged clip up to what cannot be read; a warning says where it ends"})),
    {0, "tolerance", "CODES", encoding, kBuildsCaptures, take_whole<InSource<&SourceRequest::tolerance>, 0, 65'535>,
     "differences up to this many codes are no change; 0 keeps every one (default: 0)"},
    {0, "noise", "FILE|auto", encoding, kOpensClips, take<In<&Options::noise>>,
     "the camera's noise: as nutik-cl noise measures it, or auto, measured on the clip itself. What is within it "
     "is no change, and samples are held as the light they are expected to have",
     "auto"},

    heading(kClipCodes),
    known(Setting::white_code, {0, "white", "CODE", decoding, kOpensClipsOrNoise, take_white,
     "the code that stands for white: 255, 4095 for 12 bits, …; of floating-point pictures the light of white, which "
     "must be stated: 1.0 (default: what the file says)"}),
    // Its scope is exposure: a capture has a transfer function too, and may be exposed with another.
    known(Setting::transfer, {0, "transfer", "NAME", exposure, kOpensClipsOrNoise | bit(Id::retime),
     take<InClip<&ClipOptions::transfer>>,
     "how codes stand for light: srgb, bt709, linear, gamma:G, hlg, pq or a camera's curve: slog2, slog3, vlog, clog2, "
     "clog3, logc3 (EI 800), logc4, flog, flog2, nlog, dlog, applelog, acescct (default: srgb; linear for stills "
     "and grey video of more than 8 bits and for 16-bit colour; what a file names, but for bt709 in 8-bit "
     "video; a .tik's own)",
     "srgb bt709 linear gamma: hlg pq slog2 slog3 vlog clog2 clog3 logc3 logc4 flog flog2 nlog dlog applelog acescct"}),
    known(Setting::matrix, {0, "matrix", "NAME", decoding, kOpensClipsOrNoise,
     take_choice<InClip<&ClipOptions::matrix>, YuvMatrix::bt601, YuvMatrix::bt709, YuvMatrix::bt2020, YuvMatrix::ycgco>,
     "how a video's YUV becomes RGB: bt601, bt709, bt2020 or ycgco (default: what the file says; else bt709 from "
     "720 lines on, bt601 below)",
     "bt601 bt709 bt2020 ycgco"}),
    known(Setting::range, {0, "range", "NAME", decoding, kOpensClipsOrNoise,
     take_choice<InClip<&ClipOptions::range>, CodeRange::limited, CodeRange::full>,
     "which codes are black and white: limited or full (default: the file's; else limited, grey and RGB full)",
     "limited full"}),
    known(Setting::chroma_place, {0, "chroma-at", "PLACE", decoding, kOpensClipsOrNoise,
     take_choice<InClip<&ClipOptions::chroma_at>, ChromaPlace::left, ChromaPlace::center, ChromaPlace::topleft,
     ChromaPlace::top, ChromaPlace::bottomleft, ChromaPlace::bottom>,
     "where chroma lies that pixels share: in deep video, left, center, topleft, top, bottomleft or bottom "
     "(default: what the file says, else left)",
     "left center topleft top bottomleft bottom"}),
    known(Setting::primaries, {0, "primaries", "NAME", decoding, kOpensClipsOrNoise | bit(Id::retime),
     take_by<InClip<&ClipOptions::primaries>, parse_primaries>,
     "the colours of red, green and blue: bt709, bt2020, p3, adobe-rgb, dci-p3, ap0, ap1, or a camera's: sgamut3, "
     "sgamut3-cine, vgamut, cinema-gamut, arri-wg3, arri-wg4, dgamut, apple-wide-gamut (default: the curve's, of "
     "cameras' curves; what the file says; else bt2020 if the matrix is, and bt709)",
     "bt709 bt2020 p3 adobe-rgb dci-p3 ap0 ap1 sgamut3 sgamut3-cine vgamut cinema-gamut arri-wg3 arri-wg4 dgamut "
     "apple-wide-gamut"}),
    known(Setting::pixel_aspect, {0, "pixel-aspect", "W:H", decoding, kOpensClipsOrNoise | bit(Id::retime),
     take_by<InClip<&ClipOptions::pixel_aspect>, parse_pixel_aspect>,
     "how much wider than high a pixel is: 32:27 (default: what the file says, else 1:1)"}),
    known(Setting::raw_layout, {0, "raw", "WxH:FORMAT", decoding, kOpensClipsOrNoise | bit(Id::shutter),
     take_by<InClip<&ClipOptions::raw>, parse_raw_video>,
     "a video without a header: its size and FFmpeg's name of its pixels, 480x270:yuv420p10le"}),

    heading(kEventRecording),
    known(Setting::contrast, {0, "contrast", "STEP", decoding, kOpensClipsOrNoise,
     take_by<InEvents<&EventOptions::contrast>, parse_contrast>,
     "how much light changes with an event: the step of its natural logarithm, 0.2, or up and down apart, 0.3:0.17 "
     "(default: 0.2)"}),
    known(Setting::start_picture, {0, "start-picture", "FILE|LIGHT", decoding, bit(Id::encode),
     take_by<InEvents<&EventOptions::start>, parse_start_light>,
     "light before the first event: a picture's of the same pixels, or the same everywhere, 1 being white (default: "
     "0.18)"}),
    known(Setting::tick, {0, "tick", "TIME", decoding, kOpensClipsOrNoise,
     take_by<InEvents<&EventOptions::tick_ns>, parse_tick>,
     "round events down to a tick: 100us, for fewer samples (default: the file's own times)"}),

    heading(kMovingCamera),
    {0, "align", "MOTION", encoding, kBuildsCaptures,
     take_choice<In<&Options::align>, CameraMotion::translation, CameraMotion::rigid, CameraMotion::homography,
                 CameraMotion::automatic>,
     "keep the camera still: move each picture onto the first one by translation, rigid (turning, too), "
     "homography (whatever a camera on the spot does) or auto (rigid, or homography where that says more); the clip "
     "is read twice",
     "translation rigid homography auto"},
    {0, "unseen", "HOW", encoding, kBuildsCaptures, take_choice<In<&Options::unseen>, Unseen::cropped, Unseen::held>,
     "places that some pictures did not see: crop cuts them away, hold shows what was seen there before "
     "(default: crop)",
     "crop hold"},
    {0, "align-report", "FOLDER", output, bit(Id::encode), take<In<&Options::align_report>>,
     "also write how the camera moved into a folder: path.csv, a line for each picture, plot.png, and coverage.png, "
     "how many pictures saw each place"},

    heading("The exposure"),
    {'k', "functions", "FILE.fn", exposure, kTakesFunctions, take<In<&Options::functions>>,
     "the gain functions: one for each mask value; a file with a single one needs no mask; - is standard input"},
    {'m', "mask", "FILE.pgm", exposure, kTakesFunctions | bit(Id::activity), take<In<&Options::mask>>,
     "which function each pixel is exposed with: an 8-bit grey PGM or PNG; - is standard input; "
     "layer-%d.png: a grey layer for each mask value, which says how much of a pixel it has"},
    {0, "feather", "PIXELS", exposure, kTakesFunctions, take<In<&Options::feather>>,
     "blend the mask's functions along its edges: so far to either side, 6px, M255=6px for one mask value; "
     "several with commas between: 2px,M255=6px"},
    {0, "delay", "WHERE:TIMES", exposure, kShapesExposures | bit(Id::check), take<InExposure<&ExposureRequest::delay>>,
     "expose each pixel later: rows:15ms (from the first row to the last), columns:0s..0.5s, radial:-20ms..20ms "
     "(from the centre to the corners), map.tif:0s..1s (from black to white of a grey picture)",
     "rows: columns: radial:"},
    {0, "mask-to", "FILE.pgm", exposure, kBlendsMasks, take<In<&Options::mask_to>>,
     "a second mask: that of -m on its way to it, as between two key frames of a video"},
    {0, "mask-share", "SHARE", exposure, kBlendsMasks, take_by<In<&Options::mask_way>, parse_share>,
     "how far the mask has become the second one: from 0 to 1, 3/8"},
    {0, "mask-blend", "HOW", exposure, kBlendsMasks | bit(Id::video),
     take_choice<In<&Options::mask_blend>, MaskBlend::distance, MaskBlend::alpha>,
     "how one mask turns into the other: distance (edges move) or alpha (it fades) (default: distance)",
     "distance alpha"},
    {0, "start", "TIME", exposure, kTakesIntervals, take<In<&Options::start>>,
     "expose a plain interval from here on: 0.4s, 400ms, 2/5s, 37f for pictures of the clip; with -k the "
     "functions' time 0 (default: 0s)"},
    {0, "exposure", "TIME", exposure, kTakesIntervals, take<In<&Options::exposure>>,
     "length of the plain interval: 10ms, 1/100s, 250us, or 3f: to the end of the third picture where --start "
     "counts pictures, too, else three periods"},
    {0, "pixel", "X,Y", subject, bit(Id::trace), take_by<In<&Options::pixel>, parse_pixel>,
     "the pixel to follow: counted from 0 at the top left"},
    {0, "tag", "VALUE", subject, bit(Id::trace), take_whole<In<&Options::tag>, 0, 255>,
     "follow the mean of a mask value's pixels"},
    {0, "shutter", "SHAPE", exposure, kShapesExposures, take<In<&Options::shutter>>,
     "how the shutter opens and closes: box, trapezoid:R, triangle, gaussian, hann, strobe:N[,R] or "
     "spline:0=G,…,1=G (default: box)",
     "box trapezoid: triangle gaussian hann strobe: spline:"},
    known(Setting::normalization, {0, "normalize", "BY", exposure, kTakesFunctions,
     take<InExposure<&ExposureRequest::normalization>>,
     "divide by the time with a gain (support), by its integral (integral: a still scene keeps its "
     "brightness), by that of its magnitude (absolute), or by seconds:S (default: support)",
     "support integral absolute seconds:"}),
    {0, "combine", "HOW", exposure, set_of(Id::expose, Id::video, Id::validate), take<In<&Options::combining>>,
     "what becomes of a pixel's light: its integral, its mean, or of its samples, each times its largest gain, the "
     "lightest (lighten: star trails, fireworks), the darkest or the middle one (darken, median: what moves is gone) "
     "(default: integral)",
     "integral mean lighten darken median"},
    {0, "gain", "G", exposure, kTakesFunctions | bit(Id::shutter), take_by<In<&Options::gain>, parse_signed>,
     "make the light G times as much (default: 1)"},
    {0, "ev", "E", exposure, kTakesFunctions | bit(Id::shutter), take_by<In<&Options::ev>, parse_signed>,
     "make the light 2^E times as much: 1 is one stop brighter (default: 0)"},
    {0, "every", "TIME", series, bit(Id::expose), take_by<In<&Options::every>, parse_step>,
     "expose a series: each picture this much later than the one before, 40ms, 2f; name it out-%03d.png"},
    {0, "count", "N", series, bit(Id::expose), take_whole<In<&Options::count>, 1, SeriesRequest::kMaxExposures>,
     "pictures in the series (default: as many as fit in the capture)"},
    {0, "frames", "RANGES", series, kMakesMany, take<In<&Options::frames>>,
     "only some frames, pictures or lines: of a video or series, numbered from 0, or of a batch, 7, 0-99, "
     "1-100x2, several with commas between; names keep their numbers (default: all)"},
    {0, "tag", "VALUE", subject, bit(Id::shutter), take_whole<In<&Options::tag>, 0, 255>,
     "the mask value that the function belongs to: 0 … 255 (default: 0)"},

    heading("The frames"),
    {0, "out-fps", "RATE", series, bit(Id::video), take<InFilm<&FramesRequest::rate>>,
     "frames a second that the video is played with (default: 24)"},
    {0, "out-angle", "DEGREES", series, bit(Id::video), take<InFilm<&FramesRequest::angle>>,
     "how long each frame is exposed: 360 is all the time to the next; more makes them overlap (default: 180)"},
    {0, "from", "TIME", series, bit(Id::video), take<InFilm<&FramesRequest::from>>,
     "where in the capture the video starts: 0.4s, 37f (default: 0s)"},
    {0, "to", "TIME", series, bit(Id::video), take<InFilm<&FramesRequest::to>>,
     "where in the capture the video ends; frames that would go on behind it are left out (default: the capture's"
     " end)"},
    {0, "speed", "FACTOR", series, bit(Id::video), take<InFilm<&FramesRequest::speed>>,
     "seconds of the capture in a second of the video: 0.25 is four times slower than life (default: 1)"},
    {0, "curve", "FILE.csv", series, bit(Id::video), take<In<&Options::curve>>,
     "which time each time of the video shows: in place of --from, --to and --speed, a line for each point, "
     "1.5s,0.4s; also backwards and standing still"},
    repeated("key", "TIME FILE.fn",
             "the functions at a time of the video: 2s, or 48f for frame 48; in place of -k, several times; they "
             "change from key to key",
             Id::video, series),
    repeated("mask-key", "TIME FILE.pgm", "the mask at a time of the video: in place of -m, several times", Id::video,
             series),
    known(Setting::video_codec, {0, "video-codec", "NAME", output, bit(Id::video), take<In<&Options::video_codec>>,
     "the codec: ffv1 (lossless; .mkv, .avi), h264, h265 (.mp4, .mov, .mkv), av1 (.mp4, .mkv, .webm), vp9 (.webm,"
     " .mkv), mjpeg (.avi, .mov, .mkv); of 10 bits h264-10, h265-10, av1-10; for editors prores, prores-proxy, "
     "-lt, -422, -4444 (.mov, .mkv), dnxhr-lb, -sq, -hq, -hqx, -444 (.mov, .mxf); gif, webp (default: h264, in "
     ".mkv and .avi ffv1, in .webm vp9, in .mxf dnxhr-hqx)",
     "ffv1 h264 h265 h264-10 h265-10 av1 av1-10 vp9 prores prores-proxy prores-lt prores-422 prores-4444 dnxhr-lb "
     "dnxhr-sq dnxhr-hq dnxhr-hqx dnxhr-444 mjpeg gif webp"}),
    known(Setting::crf, {0, "crf", "N", output, bit(Id::video), take_whole<InPicture<&OutputRequest::crf>, 0, 100>,
     "quality on the codec's own scale: h264 1 … 51, h265 0 … 51 (default: 17), av1, vp9 0 … 63, mjpeg 2 … 31, the "
     "less the better; webp 0 … 100"}),
    known(Setting::sound, {0, "sound", "HOW", output, bit(Id::video),
     take_choice<In<&Options::sound>, FilmSoundWish::as_it_is, FilmSoundWish::stretched, FilmSoundWish::none>,
     "the clip's sound: clip (as it is, if the film runs as fast as the file), stretch (as slow or fast as the "
     "film) or no (default: clip)",
     "clip stretch no"}),

    heading("Regions, in this order: later ones lie over earlier ones"),
    repeated("tag", "N", "the tag of the regions after it, 0 … 255 (default: 255)"),
    repeated("fill", "", "the whole picture"),
    repeated("rectangle", "X,Y,W,H", "from its top left corner, in pixels"),
    repeated("ellipse", "X,Y,RX,RY", "round a centre, with half its width and height"),
    repeated("polygon", "X,Y,X,Y,...", "three corners or more: even-odd if it crosses itself"),
    repeated("grid", "COLUMNSxROWS",
         "the whole picture, cut into cells: tagged N, N + 1, … row by row, from 0 without --tag"),
    repeated("threshold", "PICTURE LOW..HIGH",
         "pixels with a brightness in a range: 100..255 in codes, 100 for that and brighter, "
         "40%..100% of white. PICTURE is a file, or a time of the capture (0.3s, 12f)"),
    repeated("difference", "PICTURE PICTURE", "pixels in which two pictures differ: files, or times of the capture"),
    repeated("subject", "TIME", "pixels that differ from the background (nutik-cl background) at a time: 0.3s, 37f"),
    repeated("body", "TIME", "the same without soft shadows on the background"),
    repeated("moving", "", "pixels that change: within the capture, by more than its noise"),
    repeated("still", "", "pixels that do not change"),
    repeated("changed-between", "TIME TIME",
         "pixels that change from one time to another: 0.3s 0.5s, or 37f 52f"),

    heading("Changes to the region before them"),
    repeated("by", "CODES",
         "the largest difference that is no change: in codes, for --moving, --still, --changed-between, "
         "--difference and --subject (default: twice the 25th percentile of all pixels' ranges, at least 1/16 of "
         "white)"),
    repeated("within", "X,Y,W,H", "only its part in a rectangle"),
    repeated("largest", "", "only its largest connected part"),
    repeated("grow", "PIXELS", "with what is no further away"),
    repeated("shrink", "PIXELS", "without what is no further from its border"),
    repeated("smooth", "PIXELS|holes", "without specks and holes: those narrower than twice this; or without any hole"),
    repeated("invert", "", "everything else"),

    heading("The mask"),
    {0, "base", "MASK.pgm", subject, bit(Id::mask), take<In<&Options::base>>,
     "start with this mask (default: 0 everywhere)"},
    {0, "size", "WxH", subject, bit(Id::mask), take_by<In<&Options::size>, parse_mask_size>,
     "its size, if neither capture nor picture tells: 640x360"},
    {0, "feather", "PIXELS", subject, bit(Id::mask), take<In<&Options::feather>>,
     "blend tags along their edges: so far to either side, 6px, M255=6px, 2px,M255=6px; the output is layers of "
     "16 bits, one for each tag: layer-%d.png"},
    {0, "preview", "PICTURE.png", output, bit(Id::mask), take<In<&Options::preview>>,
     "also show the tags over an exposure: in colours, of all of it, or of --start and --exposure"},

    heading("What is varied, FROM..TO/STEP: one, or two as rows and columns"),
    {0, "shift", "TIMES", series, bit(Id::sweep), take_range<SweepParameter::shift>,
     "the functions later: 0..1s/0.1s, or -5f..5f/1f in pictures of the clip"},
    {0, "scale-gain", "FACTORS", series, bit(Id::sweep), take_range<SweepParameter::gain>,
     "every gain times a factor: 0.5..2/0.25"},
    {0, "stretch", "FACTORS", series, bit(Id::sweep), take_range<SweepParameter::stretch>,
     "the functions longer by a factor: from the moment that the first begins to expose, 0.5..2/0.5"},

    heading("The sheet"),
    {0, "every", "TIME", series, bit(Id::contact), take_by<In<&Options::every>, parse_step>,
     "from the start of one exposure to the next: 0.2s, 5f (default: so that 24 fit)"},
    known(Setting::columns, {0, "columns", "N", series, kMakesSheets, take_whole<In<&Options::columns>, 1, 1000>,
     "pictures beside each other (default: as many as look well)"}),
    known(Setting::width, {0, "width", "PIXELS", series, kMakesSheets,
     take_whole<In<&Options::width>, 100, plot::kLargestSide>,
     "width of the whole sheet (default: up to 1600, no picture enlarged beyond 96)"}),
    {0, "each", "NAME%02d.png", output, bit(Id::sweep), take<In<&Options::each>>,
     "also write every picture in full size: numbered from 0"},

    heading("Changes over time"),
    {0, "tag", "N", subject, bit(Id::activity), take_activity_tag,
     "count only pixels of this mask value; all: those with each value for themselves, too", "all"},
    {0, "by", "CODES", subject, bit(Id::activity), take_whole<In<&Options::by>, 0, 65'535>,
     "the largest difference that is no change: of codes, at a sample (default: 0)"},
    {0, "moment", "quietest|busiest", subject, bit(Id::activity), take<In<&Options::moment>>,
     "print only that stretch: as options for another command, --start 12f --exposure 9f"},
    {0, "csv", "FILE.csv", output, bit(Id::activity), take<In<&Options::csv>>,
     "a line for each sample, - for standard output"},
    {0, "map", "MAP.png", output, bit(Id::activity), take<In<&Options::map>>,
     "also write where it changes: as info --activity does, black never, white most often"},

    heading("The study"),
    {0, "style", "NAME", subject, bit(Id::study),
     take_choice<InStudy<&StudyRequest::style>, StudyStyle::trail, StudyStyle::strobe, StudyStyle::rear_curtain,
     StudyStyle::frozen, StudyStyle::clean, StudyStyle::slit>,
     "what the picture shows: trail (sharp moments over the whole way), strobe (moments alone), rear-curtain (the"
     " last moment, and a trail that grows towards it), frozen (one moment in a scene exposed for all of the "
     "time), clean (the scene without moving things) or slit (strips, each later than the one before it) "
     "(default: trail)",
     "trail strobe rear-curtain frozen clean slit"},
    {0, "moments", "N|TIMES", subject, bit(Id::study), take_by<InStudy<&StudyRequest::moments>, parse_moments>,
     "how many moments, or which: up to 50, 7, or 0.36s,0.75s,1.27s (default: 5; of rear-curtain and frozen 1); "
     "of slit how many strips, up to 256 (default: 256)"},
    repeated("region", "X,Y,W,H",
         "look for a subject in this rectangle only; several times for as many subjects, each in its own",
         Id::study),
    {0, "spacing", "time|distance", subject, bit(Id::study),
     take_choice<InStudy<&StudyRequest::spacing>, MomentSpacing::time, MomentSpacing::distance>,
     "how moments are evenly apart: in time, or along the way (default: time)", "time distance"},
    {0, "trail", "SHAPE", subject, bit(Id::study),
     take_choice<InStudy<&StudyRequest::trail>, TrailShape::even, TrailShape::fade, TrailShape::ramp, TrailShape::none>,
     "the trail's shape: even, fade (ends at nothing), ramp (begins at nothing) or none (default: even of trail "
     "and frozen, ramp of rear-curtain, none of strobe)",
     "even fade ramp none"},
    {0, "by", "CODES", subject, bit(Id::study), take_whole<In<&Options::by>, 1, 65'535>,
     "the largest difference that is no subject: from the empty scene, in codes; fewer find what hardly stands "
     "out, more leave out shadows (default: 1/16 of white; twice the noise, if that is more, for the subject's "
     "outline)"},
    {0, "feather", "PIXELS", exposure, bit(Id::study), take<In<&Options::feather>>,
     "blend the edges of subject or strips: over so many pixels, 6px, at most 32px (default: 2px; strips: 0px)"},
    {0, "slit-from", "SIDE", subject, bit(Id::study),
     take_choice<InStudy<&StudyRequest::slit_from>, SlitFrom::left, SlitFrom::right, SlitFrom::top, SlitFrom::bottom>,
     "where slit begins: left, right (columns), top or bottom (rows) (default: left)", "left right top bottom"},

    heading("What is solved for"),
    repeated("wish", "WISH",
         "what the picture should have: once for each wish, 'M0 = background', 'R1 gone', 'M64 like 0.8s', "
         "'500,120,80,60 <= 0.5'. A region (all, M64, R1, X,Y,WIDTH,HEIGHT, M64 within X,Y,WIDTH,HEIGHT), then "
         "gone, or =, <=, >=, like and light: a number, background, a time, a region, also 1.5 * background",
         Id::solve),
    repeated("free", "NAME=FROM..TO",
         "bounds of a gain or a time: rest=-100..0 (default: none), or when a time may be, when=0.6s..0.8s, in "
         "steps when=60f..80f/1f (default: any)",
         Id::solve),
    {0, "regions", "MASK.pgm", subject, bit(Id::solve), take<In<&Options::regions>>,
     "a second mask: its values are the regions R0 … R255 of wishes"},

    heading("The background"),
    {0, "by", "CODES", subject, bit(Id::background), take_whole<In<&Options::by>, 0, 65'535>,
     "how far codes of the same light may differ: to either side (default: three standard deviations of the "
     "capture's noise, at least 1/32 of white)"},
    {0, "uncertain", "MASK.pgm", output, bit(Id::background), take<In<&Options::uncertain>>,
     "also write where it is uncertain: as tag 255 the pixels that hold their light for less than half of the "
     "time"},

    heading(kComputing),
    known(Setting::renderer, {0, "renderer", "NAME", computing, kExposes,
     take_choice<In<&Options::renderer>, RendererKind::opencl, RendererKind::reference>,
     "what computes: opencl, or reference, plain double precision on the processor, slow (default: opencl)",
     "opencl reference"}),
    {0, "device", "NAME", computing, kExposes | bit(Id::validate), take<In<&Options::device>>,
     "the OpenCL device: its number or part of its name; several that make each picture together: 0,1, or all; "
     "NUTIK_DEVICE does the same (default: the first GPU, else the first device)"},
    known(Setting::precision, {0, "precision", "NAME", computing, kExposes,
     take_by<In<&Options::precision>, parse_wished_precision>,
     "the arithmetic: single, compensated, double, fixed (the same bytes on every device), or auto: the fastest "
     "that is sure to be right to half a code, or to half a float's step (default: auto; see -v)",
     "auto single compensated double fixed"}),
    {0, "strict", "", computing, kExposes, take<In<&Options::strict>>,
     "refuse what may err by more than half a code, or half a float's step: an error with exit status 7"},
    {0, "memory", "SIZE", computing, kOpensClipsOrNoise | kExposes, take_by<In<&Options::memory>, parse_memory>,
     "the most that may be held: 500MB, 2GB, 1GiB; libraries and drivers come on top (default: half of the "
     "machine's)"},

    heading("Validation"),
    {0, "source", "CLIP", subject, bit(Id::validate), take<In<&Options::source_clip>>,
     "also compare the capture with its clip: picture by picture"},

    heading(kOutputs),
    {'o', "output", "FILE", output,
     kWrites & ~set_of(Id::batch, Id::info, Id::thumbnail), take<In<&Options::output>>,
     "where to write; without it the last operand, or a name made from the inputs. A picture goes to "
     "standard output as -, a PNG, or as exr:-, tif:-, …"},
    known(Setting::depth, "dtype", {0, "depth", "BITS", exposure, set_of(Id::expose, Id::video, Id::validate,
     Id::background, Id::study),
     take_choice<InPicture<&OutputRequest::depth>, Depth::bits8, Depth::bits16, Depth::half, Depth::floating,
     Depth::doubled>,
     "bits of the picture: 8, 16, float, double (.tif, .npy) or half (.exr): light as it is, with negatives (default: "
     "the capture's own, 8 for .jpg, float for .exr, .pfm and .npy)",
     "8 16 half float double"}),
    {0, "bounds", "MAP.tif", output, set_of(Id::expose, Id::video),
     take<InPicture<&OutputRequest::bounds>>,
     "also write what each pixel may be off by, in codes or in light, and each term of it: as floats, in layers of an "
     ".exr, pages of a .tif, along the first axis of a .npy; of many pictures with a number, map-%04d.tif"},
    known(Setting::quality, {0, "quality", "N", exposure, kExposesFreely | set_of(Id::background, Id::study),
     take_whole<InPicture<&OutputRequest::quality>, 1, 100>,
     "quality from 1 to 100: of .jpg pictures, and of films whose codec loses something (default: 90 of .jpg, of "
     "films the codec's)"}),
    known(Setting::keep_pixels, {0, "keep-pixels", "", exposure,
     set_of(Id::expose, Id::sweep, Id::video, Id::background, Id::study), take<InPicture<&OutputRequest::keep_pixels>>,
     "keep pixels that are not square: to measure in them (default: .png, .jpg and films of lossy codecs come in "
     "square ones, unless --depth 16 or --out-transfer source is stated; other files as they are)"}),
    {0, "negative", "HOW", exposure, kExposesFreely,
     take_choice<InPicture<&OutputRequest::negative>, NegativeLight::saturate, NegativeLight::offset,
     NegativeLight::absolute>,
     "what codes make of light below 0: saturate (black), offset (light 0 is mid-grey, light below it "
     "darker), abs (as bright as light above it) (default: saturate)",
     "saturate offset abs"},
    known(Setting::out_transfer, "transfer", {0, "out-transfer", "NAME", exposure,
     set_of(Id::expose, Id::video, Id::sweep, Id::trace, Id::validate, Id::background, Id::study),
     take_by<InPicture<&OutputRequest::transfer>, parse_out_transfer>,
     "how the picture's codes stand for light: srgb, bt709, linear, gamma:G, or source: as in the capture, "
     "with its own white code (default: srgb, white being the largest code)",
     "srgb source linear bt709 gamma:"}),
    {0, "codec", "NAME", encoding, bit(Id::encode), take<In<&Options::codec>>,
     "how blocks are packed: none (large, quickest to expose), rice (quick to pack and unpack), lz4, zstd (small)"
     " or zstd:1 … zstd:19 (smaller, slower); with a tolerance rice also packs blocks that it makes smaller than lz4 "
     "and zstd (default: rice)",
     "none rice lz4 zstd zstd:"},
    {0, "activity", "MAP.png", output, bit(Id::info), take<In<&Options::activity>>,
     "also write how often each pixel changes: a grey picture, black never, white most often, between them sRGB"},
    {0, "width", "PIXELS", output, bit(Id::thumbnail), take_whole<In<&Options::width>, 1, 4096>,
     "length of the longer side (default: 256); no picture is enlarged"},
    {0, "points", "", answer, bit(Id::check), take<In<&Options::points>>,
     "print only the control points of -k: a line for each, mask value, nanoseconds, gain"},
    {0, "json", "", answer, kAll & ~kOnlyPrints, take<In<&Options::json>>, "answer with one JSON object, for scripts"},
    {0, "no-recipe", "", output, kExposes & ~bit(Id::mask), take<In<&Options::no_recipe>>,
     "do not keep in the picture how it was made: names, functions and options (see nutik-cl reproduce)"},
    {0, "skip-existing", "", output, kMakesMany, take<In<&Options::skip_existing>>,
     "leave out pictures that are there already: with the recipe that they would get"},
    {0, "overwrite", "", output, kWrites, take<In<&Options::overwrite>>,
     "replace files that are there already; without it only unchanged pictures with a recipe are replaced"},
    {0, "in-place", "", output, bit(Id::retime), take<In<&Options::in_place>>, "change the capture itself"},
    {'q', "quiet", "", output, kAll, take<In<&Options::quiet>>, "no progress bar and no summary"},
    {'v', "verbose", "", output, (kExposes & ~set_of(Id::mask, Id::solve)) | bit(Id::trace),
     take<In<&Options::verbose>>,
     "say more: what is read and what is skipped, in which precision and why, how fast and with how much "
     "memory; every step of a trace"},

    heading(kSeldomNeeded),
    {0, "sigmas", "K", encoding, kOpensClips, take_by<InSource<&SourceRequest::sigmas>, parse_sigmas>,
     "how many deviations of the noise are no change: standard deviations from the held light, with --noise "
     "(default: 3)"},
    {0, "align-to", "TIME", encoding, kBuildsCaptures, take<In<&Options::align_to>>,
     "the picture onto which the others are moved: its time, 0.5s, 60f (default: the first)"},
    {0, "align-along", "FILE.csv", encoding, bit(Id::encode), take<In<&Options::align_along>>,
     "move pictures along a path: one that --align-report wrote, be it changed by hand"},
    {0, "camera-path", "PATH.csv", output, bit(Id::encode), take<In<&Options::camera_path>>,
     "also write how the camera moved: a line for each picture"},
    {0, "camera-plot", "PLOT.png", output, bit(Id::encode), take<In<&Options::camera_plot>>,
     "also draw how the camera moved"},
    {0, "coverage", "MAP.png", output, bit(Id::encode), take<In<&Options::coverage>>,
     "also write how many pictures saw each place: as a grey picture, white all of them"},
    known(Setting::unmapped, {0, "unmapped", "zero", exposure, kTakesFunctions,
     take_choice<InExposure<&ExposureRequest::plan, &PlanOptions::unmapped_is_zero>, true>,
     "expose mask values without a function to black (default: an error)", "zero"}),
    known(Setting::count_redrawn, {0, "count-redrawn", "", subject, bit(Id::activity),
     take<In<&Options::counts_redrawn>>,
     "also count changes of a whole picture at once: its codec drew it anew, as at key frames, or the camera "
     "changed its exposure (default: they count as those beside them)"}),
    {0, "runs", "N", subject, bit(Id::validate), take_whole<In<&Options::runs>, 1, 10'000>,
     "renders that are timed: in each arithmetic, in turns (default: 5)"},
    {0, "progress", "", output, kMakesMany | set_of(Id::encode, Id::join), take<In<&Options::progress>>,
     "print progress where stderr is no terminal: a line a second, Progress: 45% …"},
    {0, "live", "all", exposure, kShapesExposures,
     take_choice<InExposure<&ExposureRequest::plan, &PlanOptions::live_all>, true>,
     "visit every sample, also if no gain needs it (the picture is the same)", "all"},
    {0, "shutter-error", "E", exposure, kShapesExposures | bit(Id::shutter),
     take_by<In<&Options::shutter_error>, parse_shutter_error>,
     "how far a smooth shape may be from its gains: as a share of the largest (default: 0.001)"},
    {0, "tiles", "KIND", encoding, kBuildsCaptures,
     take_choice<InSource<&SourceRequest::tiles>, TilePolicy::automatic, TilePolicy::dense, TilePolicy::rows,
     TilePolicy::records>,
     "auto, or all tiles as dense, rows or records, for experiments (default: auto)",
     "auto dense rows records"},
    known(Setting::block_samples, {0, "block-samples", "N", encoding, kBuildsCaptures,
     take_whole<InSource<&SourceRequest::block_samples>, 1, kLargestBlockSamples>,
     "samples in a block (default: 64, fewer where much of a large picture changes)"}),
};

std::vector<Option> rows_under_headings() {
  std::vector<Option> table;
  std::string_view heading;
  for (const Option& row : kRows) {
    if (row.long_name.empty()) {
      heading = row.heading;
    } else {
      table.emplace_back(row).heading = heading;
    }
  }
  return table;
}

}  // namespace

std::span<const Option> schema() {
  static const std::vector<Option> table = rows_under_headings();
  return table;
}

}  // namespace nutik
