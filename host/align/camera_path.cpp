#include "align/camera_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "capture/error.hpp"
#include "capture/format.hpp"
#include "capture/source_text.hpp"
#include "capture/text.hpp"
#include "media/module.hpp"

namespace nutik {
namespace {

constexpr std::array<std::pair<CameraMotion, std::string_view>, 4> kMotions{
    {{CameraMotion::translation, "translation"},
     {CameraMotion::rigid, "rigid"},
     {CameraMotion::homography, "homography"},
     {CameraMotion::automatic, "auto"}}};

}  // namespace

std::string_view to_text(CameraMotion motion) {
  return std::ranges::find(kMotions, motion, &decltype(kMotions)::value_type::first)->second;
}

std::optional<CameraMotion> camera_motion_of(std::string_view text) {
  const auto found = std::ranges::find(kMotions, text, &decltype(kMotions)::value_type::second);
  return found == kMotions.end() ? std::nullopt : std::optional(found->first);
}

std::unique_ptr<Registrar> open_registrar(const CaptureFormat& format, std::span<const std::byte> reference) {
  return module<MotionModule>().open(format, reference);
}

std::uint64_t registered_bytes(const CaptureFormat& format) {
  constexpr std::uint64_t kPyramidBytes = 12;  // a pixel: as it is, blurred, and all smaller ones
  const std::uint64_t pixels = format.shape.pixel_count(), of_thin = pixels >> 2 * registered_halvings(format.shape);
  return kPyramidBytes * std::max(std::min(pixels, kMaxRegisteredPixels), of_thin);
}

MemoryNeeds registrar_needs(const CaptureFormat& format, Reach reach) {
  constexpr std::uint64_t kTextureBytes = 4 << 20;
  constexpr std::uint64_t kFeatureBytes =
      240;  // a pixel of what features are looked for in: twice its size, in
            // eleven layers of floats, and all smaller ones
  constexpr std::uint64_t kMaxFeaturePixels = 480 * 480;
  const std::uint64_t pixels = format.shape.pixel_count();
  MemoryNeeds needs{{"a picture that is registered", registered_bytes(format)}, {"its texture", kTextureBytes}};
  if (reach == Reach::anywhere)
    needs.add("its features", kFeatureBytes * std::min(pixels, kMaxFeaturePixels));
  return needs;
}

CameraPath::Step CameraPath::step(std::uint64_t picture) const {
  const double x = (shape.width - 1) / 2.0, y = (shape.height - 1) / 2.0;
  const Warp& warp = pictures[picture].warp;
  const Place place = warp.at(x, y);
  return {place.x - x, place.y - y, warp.degrees_at(x, y)};
}

Place furthest_way(const Warp& warp, const Shape& shape) {
  const double right = shape.width - 1.0, bottom = shape.height - 1.0;
  Place most;
  for (const auto& [x, y] : {Place{right / 2, bottom / 2}, {0, 0}, {right, 0}, {0, bottom}, {right, bottom}}) {
    const Place place = warp.at(x, y), way{place.x - x, place.y - y};
    if (std::hypot(way.x, way.y) > std::hypot(most.x, most.y)) most = way;
  }
  return most;
}

CameraPath::Furthest CameraPath::furthest() const {
  Furthest most;
  for (std::uint64_t picture = 0; picture < pictures.size(); ++picture) {
    const Furthest found{picture, furthest_way(pictures[picture].warp, shape)};
    if (found.pixels() > most.pixels()) most = found;
  }
  return most;
}

std::uint64_t CameraPath::max_turned() const {
  std::uint64_t best = 0;
  for (std::uint64_t picture = 1; picture < pictures.size(); ++picture) {
    if (std::abs(step(picture).degrees) > std::abs(step(best).degrees)) best = picture;
  }
  return best;
}

std::optional<double> CameraPath::residual_pixels() const {
  if (is_stated) return std::nullopt;
  return pictures.empty() ? 0 : std::ranges::max(pictures, {}, &Registered::residual_pixels).residual_pixels;
}

std::string CameraPath::summary() const {
  std::string text = format("moved by up to {:.2f} pixels", furthest().pixels());
  if (motion == CameraMotion::translation) return text;
  return text + format(", turned by up to {:.3f} degrees", std::abs(step(max_turned()).degrees));
}

namespace {

constexpr double kRounding = 1e-6;

}  // namespace

PixelSpan seen_span(const Warp& warp, const Shape& shape, std::uint32_t row) {
  const auto& m = warp.m;
  const double y = row;
  double low = 0, high = shape.width - 1;
  // a x + b >= 0 for the four borders and for what lies before the camera.
  const auto cut = [&](double a, double b) {
    if (a > 0) {
      low = std::max(low, -b / a);
    } else if (a < 0) {
      high = std::min(high, -b / a);
    } else if (b < 0) {
      high = -1;
    }
  };
  const double x_rest = m[1] * y + m[2], y_rest = m[4] * y + m[5], z_rest = m[7] * y + m[8];
  const double right = shape.width - 1 + kSeenBeyond, bottom = shape.height - 1 + kSeenBeyond;
  cut(m[6], z_rest - kRounding);
  cut(m[0] + kSeenBeyond * m[6], x_rest + kSeenBeyond * z_rest);
  cut(m[3] + kSeenBeyond * m[6], y_rest + kSeenBeyond * z_rest);
  cut(right * m[6] - m[0], right * z_rest - x_rest);
  cut(bottom * m[6] - m[3], bottom * z_rest - y_rest);
  const double first = std::ceil(low - kRounding), last = std::floor(high + kRounding);
  if (!(first <= last)) return {};
  return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last) + 1};
}

std::optional<Rectangle> seen_by_all(const CameraPath& path) {
  const Shape& shape = path.shape;
  std::vector<PixelSpan> rows(shape.height, PixelSpan{0, shape.width});
  for (const Registered& picture : path.pictures) {
    for (std::uint32_t y = 0; y < shape.height; ++y) {
      const PixelSpan span = seen_span(picture.warp, shape, y);
      rows[y].first = std::max(rows[y].first, span.first);
      rows[y].end = std::min(rows[y].end, span.end);
    }
  }
  // What all saw is convex, so that a rectangle lies in it if its first and its last row do.
  std::optional<Rectangle> best;
  std::uint64_t most = 0;
  for (std::uint32_t top = 0; top < shape.height; ++top) {
    for (std::uint32_t bottom = top; bottom < shape.height; ++bottom) {
      const std::uint32_t first = std::max(rows[top].first, rows[bottom].first);
      const std::uint32_t end = std::min(rows[top].end, rows[bottom].end);
      if (first >= end) continue;
      const std::uint64_t pixels = std::uint64_t{end - first} * (bottom - top + 1);
      if (pixels <= most) continue;
      most = pixels;
      best = Rectangle{first, top, end - first, bottom - top + 1};
    }
  }
  return best;
}

Picture coverage_of(const CameraPath& path) {
  const Shape& shape = path.shape;
  Picture coverage({shape.width, shape.height, 1}, ValueType::code8, 255);
  auto* code = coverage.values<std::uint8_t>().data();
  const std::uint64_t all = std::max<std::uint64_t>(path.pictures.size(), 1);
  std::vector<std::uint64_t> seen(shape.width);  // of a row
  for (std::uint32_t y = 0; y < shape.height; ++y) {
    std::ranges::fill(seen, 0);
    for (const Registered& picture : path.pictures) {
      const PixelSpan span = seen_span(picture.warp, shape, y);
      for (std::uint32_t x = span.first; x < span.end; ++x) ++seen[x];
    }
    // Rounded down: 255 is kept for what all saw.
    for (const std::uint64_t count : seen) *code++ = static_cast<std::uint8_t>(255 * count / all);
  }
  return coverage;
}

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

  // What stands before the first of these letters, or all; both are left out of `text`.
  static std::string_view cut(std::string_view& text, char letter) {
    const std::string_view front = text.substr(0, text.find(letter));
    text.remove_prefix(std::min(front.size() + 1, text.size()));
    return front;
  }

  std::string_view next_line() {
    ++line_;
    return cut(rest_, '\n');
  }

  // `# nutik camera path,rigid,reference 12,640 x 480`, with commas between, as spreadsheets leave it.
  void take_title() {
    line_left_ = next_line();
    if (next_word() != kTitle)
      fail(format("this is no camera's path: '{},MOTION,REFERENCE,WIDTH,HEIGHT' is expected", kTitle));
    const auto motion = camera_motion_of(next_word());
    if (!motion || *motion == CameraMotion::automatic) fail("it names no motion: translation, rigid or homography");
    path_.motion = *motion;
    path_.reference = take<std::uint64_t>("the reference");
    path_.is_stated = true;
    path_.shape = {take<std::uint32_t>("the width"), take<std::uint32_t>("the height"), 1};
    if (path_.shape.pixel_count() == 0) fail("its pictures have no pixels");
  }

  void take_picture() {
    if (take<std::uint64_t>("the picture") != path_.pictures.size()) {
      fail(format("picture {} is expected here", path_.pictures.size()));
    }
    for (int column = 1; column < 6; ++column) next_word();  // for people
    Registered picture;
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

  std::string_view next_word() { return cut(line_left_, ','); }

  template <typename Number>
  Number take(std::string_view what) {
    const std::string_view word = next_word();
    const auto number = parsed<Number>(word);
    if (!number || !std::isfinite(*number))
      fail(format("{} is {}, which is no number that it can be", what, quoted(word)));
    return *number;
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
