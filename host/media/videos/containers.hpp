// Which of FFmpeg's containers are read, by the names of their readers. It knows hundreds, among them playlists, texts
// and devices: what is not named here is refused.
// SECURITY.md names the same, which a test compares.
#pragma once

#include <algorithm>
#include <span>
#include <string_view>

namespace nutik::videos {

struct Containers {
  std::span<const std::string_view> names;
  std::string_view refusal = {};  // why they are not read, and what helps; empty: they are
};

inline constexpr std::string_view kFilms[] = {
    "apng",   "asf",       "avi", "cine", "dv",  "flv", "gif",    "gxf",     "ivf", "mpeg",
    "mpegts", "mpegvideo", "mxf", "nut",  "ogg", "rm",  "smjpeg", "vc1test", "wtv", "yuv4mpegpipe"};
// Those with several names each.
inline constexpr std::string_view kFamilies[] = {"matroska,webm", "mov,mp4,m4a,3gp,3g2,mj2"};
// Pictures one behind the other, which may say how fast they follow each other; stills, as pipes carry them, do not.
inline constexpr std::string_view kStreams[] = {"av1",        "avs2", "avs3",     "cavsvideo", "dirac",
                                                "dnxhd",      "h264", "hevc",     "m4v",       "mjpeg",
                                                "mjpeg_2000", "obu",  "rawvideo", "vc1"};
inline constexpr std::string_view kPipes[] = {"jpeg_pipe", "pbm_pipe", "pgm_pipe", "png_pipe", "ppm_pipe"};
// None of these says it, and FFmpeg makes up a rate.
inline constexpr std::string_view kUntimed[] = {"h261", "h263", "mpjpeg"};
inline constexpr std::string_view kRefusedPlaylists[] = {"concat", "dash", "hls", "imf", "sdp", "vobsub"};
inline constexpr std::string_view kRefusedTexts[] = {"adf", "bin", "idf", "tty", "xbin"};
inline constexpr std::string_view kRefusedStills[] = {"dpx_pipe",    "ico",      "j2k_pipe",  "jpegls_pipe",
                                               "jpegxl_pipe", "psd_pipe", "tiff_pipe", "webp_pipe"};
inline constexpr std::string_view kFits[] = {"fits"}, kMlv[] = {"mlv"}, kSer[] = {"ser"};

inline constexpr Containers kContainers[] = {
    {kFilms},
    {kFamilies},
    {kStreams},
    {kPipes},
    {kUntimed},
    {kRefusedPlaylists,
     "names other files, and none is opened that you did not name. ffmpeg -i LIST -c copy film.mkv makes one file of "
     "them"},
    {kRefusedTexts, "is text, which could be shown letter by letter but is no film"},
    {kRefusedStills,
     "is a still picture of a kind that is not read. ffmpeg -i PICTURE PICTURE.png, or .tif, makes one that is"},
    {kFits,
     "would be stretched, each picture between its own darkest and brightest pixel. Save 16-bit TIFFs, with Siril for "
     "one, whose codes stay, and state their rate"},
    {kMlv,
     "is the mosaic of a sensor, whose black, white and colours would be lost. MLV App makes DNGs of it, which are "
     "developed"},
    {kSer,
     "would be read with bytes, depth and times as few of its writers mean them. Save 16-bit TIFFs, with Siril for "
     "one, and state their rate"}};

// Null where nothing is said of it.
[[nodiscard]] inline const Containers* containers_with(std::string_view name) {
  const auto found = std::ranges::find_if(kContainers, [&](const Containers& each) {
    return std::ranges::find(each.names, name) != each.names.end();
  });
  return found == std::end(kContainers) ? nullptr : &*found;
}

}  // namespace nutik::videos
