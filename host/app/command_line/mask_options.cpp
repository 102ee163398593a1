#include "app/command_line/option_groups.hpp"

namespace nutik::app {
namespace {

constexpr std::string_view kPixels = "Which pixels";
constexpr std::string_view kRegions = "Regions, in this order: later ones lie over earlier ones";
constexpr std::string_view kChanges = "Changes to the region before them";
constexpr std::string_view kMask = "The mask";
constexpr CommandSet kMaskOnly = bit(CommandId::mask);

}  // namespace

std::vector<Option> mask_options() {
  return {
      step("tag", "N", kRegions, "the tag of the regions after it, 0 … 255 (default: 255)", kMaskOnly),
      step("fill", {}, kRegions, "the whole picture", kMaskOnly),
      step("rectangle", "X,Y,W,H", kRegions, "from its top left corner, in pixels", kMaskOnly),
      step("ellipse", "X,Y,RX,RY", kRegions, "round its centre, with half its width and height", kMaskOnly),
      step("polygon", "X,Y,X,Y,...", kRegions, "three corners or more, even-odd where it crosses itself",
           kMaskOnly),
      step("grid", "COLUMNSxROWS", kRegions,
           "the whole picture, cut into cells that are tagged N, N + 1, … row by row, from 0 without --tag",
           kMaskOnly),
      step("threshold", "PICTURE LOW..HIGH", kRegions,
           "where a picture's brightness lies in a range: 100..255 in codes, 100 for that and brighter, "
           "40%..100% of "
           "white. PICTURE is a file, or a time of the capture (0.3s, 12f)",
           kMaskOnly),
      step("difference", "PICTURE PICTURE", kRegions, "where two pictures, or times of the capture, differ",
           kMaskOnly),
      step("moving", {}, kRegions, "pixels that change within the capture by more than its noise", kMaskOnly),
      step("still", {}, kRegions, "the others", kMaskOnly),
      step("changed-between", "TIME TIME", kRegions,
           "pixels that change from one time to another: 0.3s 0.5s, or 37f 52f", kMaskOnly),
      step("by", "CODES", kChanges,
           "the least that is no change: for --moving, --still, --changed-between and --difference, codes "
           "must differ by more (default: twice what a quarter of all pixels stay within, at least 1/16 of "
           "white)",
           kMaskOnly),
      step("within", "X,Y,W,H", kChanges, "only its part in a rectangle", kMaskOnly),
      step("largest", {}, kChanges, "only its largest connected part", kMaskOnly),
      step("grow", "PIXELS", kChanges, "and all that is no further away than this", kMaskOnly),
      step("shrink", "PIXELS", kChanges, "without all that is no further than this from its border",
           kMaskOnly),
      step("smooth", "PIXELS", kChanges, "without specks and holes narrower than twice this", kMaskOnly),
      step("invert", {}, kChanges, "everything else", kMaskOnly),
      valued(0, "base", "MASK.pgm", kMask, "start with this mask (default: 0 everywhere)", kMaskOnly,
             &Options::base),
      valued(0, "size", "WxH", kMask, "its size, where neither capture nor picture tells: 640x360", kMaskOnly,
             &Options::size),
      valued(0, "preview", "PICTURE.png", kMask,
             "also show the tags in colours over an exposure of the capture: of all of it, or of --start and "
             "--exposure",
             kMaskOnly, &Options::preview),
  };
}

}  // namespace nutik::app
