#include <charconv>
#include <cmath>
#include <cstddef>

#include "align/camera_path.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/source_text.hpp"

namespace nutik {
namespace {

constexpr std::string_view kTitle = "# nutik camera path";
constexpr std::string_view kColumns =
    "picture,x,y,degrees,residual_pixels,agreeing,m0,m1,m2,m3,m4,m5,m6,m7,m8";

class PathParser {
 public:
  PathParser(const SourceText& text, const std::string& name) : rest_(text.view()), name_(name) {}

  CameraPath parse() {
    take_title();
    if (next_line() != kColumns) fail(format("its columns are not {}", kColumns));
    while (!rest_.empty()) {
      line_left_ = next_line();
      if (!line_left_.empty()) take_picture();
    }
    if (path_.reference >= path_.pictures.size()) {
      fail(format("it has {} pictures, and picture {} is the one that they were aligned to",
                  path_.pictures.size(), path_.reference));
    }
    return std::move(path_);
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw InputError(
        format("{}:{}: {}; the path of a camera is written when a clip is aligned", name_, line_, why));
  }

  std::string_view next_line() {
    const std::size_t end = rest_.find('\n');
    const std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++line_;
    return line;
  }

  // `# nutik camera path,rigid,reference 12,640 x 480`, with commas between, as spreadsheets leave it.
  void take_title() {
    line_left_ = next_line();
    if (next_word() != kTitle) fail("this is no camera's path");
    const auto motion = camera_motion_of(next_word());
    if (!motion) fail("it names no motion: translation, rigid or homography");
    path_.motion = *motion;
    path_.reference = take<std::uint64_t>("the reference");
    path_.shape = {take<std::uint32_t>("the width"), take<std::uint32_t>("the height"), 1};
    if (path_.shape.pixel_count() == 0) fail("its pictures have no pixels");
  }

  void take_picture() {
    if (take<std::uint64_t>("the picture") != path_.pictures.size()) {
      fail(format("picture {} is expected here", path_.pictures.size()));
    }
    for (int column = 0; column < 3; ++column) take<double>("a step");
    Registered picture;
    picture.residual_pixels = take<double>("the residual");
    picture.agreeing = take<double>("the share that agrees");
    for (double& entry : picture.warp.m) entry = take<double>("the warp");
    if (!line_left_.empty()) fail(format("there is more than a line has: {}", quoted(line_left_)));
    check_warp(picture.warp);
    path_.pictures.push_back(picture);
  }

  // It must lead each corner of the picture to a place, and leave it no mirror picture.
  void check_warp(const Warp& warp) const {
    const auto& m = warp.m;
    constexpr double kMaxEntry = 1e6;  // far beyond any picture, and all that follows from it is a number
    for (const double entry : m) {
      if (!(std::abs(entry) <= kMaxEntry))
        fail(format("the warp has {}, and {} is the most", entry, kMaxEntry));
    }
    const double right = path_.shape.width, bottom = path_.shape.height;
    for (const double x : {0.0, right}) {
      for (const double y : {0.0, bottom}) {
        if (!(m[6] * x + m[7] * y + m[8] > 1e-6)) fail("the warp has no place for a corner of the picture");
      }
    }
    if (!(m[0] * m[4] - m[1] * m[3] > 1e-6)) fail("the warp makes the picture flat, or a mirror picture");
  }

  std::string_view next_word() {
    const std::size_t end = line_left_.find(',');
    const std::string_view word = line_left_.substr(0, end);
    line_left_.remove_prefix(end == std::string_view::npos ? line_left_.size() : end + 1);
    return word;
  }

  template <typename Number>
  Number take(std::string_view what) {
    const std::string_view word = next_word();
    Number number{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    bool is_right = error == std::errc() && end == word.data() + word.size();
    if constexpr (std::is_floating_point_v<Number>) is_right &= std::isfinite(number);
    if (!is_right) fail(format("{} is {}, which is no number that it can be", what, quoted(word)));
    return number;
  }

  std::string_view rest_, line_left_;
  const std::string& name_;
  std::size_t line_ = 0;
  CameraPath path_;
};

}  // namespace

std::string camera_path_text(const CameraPath& path) {
  std::string text = format("{},{},{},{},{}\n{}\n", kTitle, to_text(path.motion), path.reference,
                            path.shape.width, path.shape.height, kColumns);
  for (std::uint64_t i = 0; i < path.pictures.size(); ++i) {
    const Registered& picture = path.pictures[i];
    const auto [x, y, degrees] = path.step(i);
    text +=
        format("{},{:.4f},{:.4f},{:.5f},{},{}", i, x, y, degrees, picture.residual_pixels, picture.agreeing);
    for (const double entry : picture.warp.m) text += format(",{}", entry);
    text += "\n";
  }
  return text;
}

CameraPath parse_camera_path(std::string_view text, const std::string& name) {
  const SourceText source(text);
  return PathParser(source, name).parse();
}

}  // namespace nutik
