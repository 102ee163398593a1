#include "media/stills/raw_file.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <libraw/libraw.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <cstring>
#include <string>

#include "capture/error.hpp"
#include "capture/format.hpp"

namespace nutik::stills {

// What LibRaw develops by.
struct RawDeveloper::Levels {
  explicit Levels(const libraw_colordata_t& color) : black(color.black), maximum(color.maximum) {
    std::ranges::copy(color.cblack, pattern);
    std::ranges::copy(color.cam_mul, balance);
    std::ranges::copy(color.pre_mul, daylight);
    std::memcpy(matrix, color.rgb_cam, sizeof matrix);
  }
  void put(libraw_colordata_t& color) const {
    color.black = black;
    color.maximum = maximum;
    std::ranges::copy(pattern, color.cblack);
    std::ranges::copy(balance, color.cam_mul);
    std::ranges::copy(daylight, color.pre_mul);
    std::memcpy(color.rgb_cam, matrix, sizeof matrix);
  }

  decltype(libraw_colordata_t::black) black;
  decltype(libraw_colordata_t::maximum) maximum;
  decltype(libraw_colordata_t::cblack) pattern;
  decltype(libraw_colordata_t::cam_mul) balance;
  decltype(libraw_colordata_t::pre_mul) daylight;
  decltype(libraw_colordata_t::rgb_cam) matrix;
};

RawDeveloper::RawDeveloper() = default;
RawDeveloper::~RawDeveloper() = default;

Picture RawDeveloper::develop(const std::filesystem::path& file) {
  const auto raw = std::make_unique<LibRaw>();  // too large for a thread's stack
  const auto check = [&](int code) {
    if (code != LIBRAW_SUCCESS) {
      throw InputError(format("{} cannot be read: LibRaw says: {}", file.string(), libraw_strerror(code)));
    }
  };
  libraw_output_params_t& wishes = raw->imgdata.params;
  wishes.output_bps = 16;
  wishes.output_color = 1;  // BT.709's primaries
  wishes.gamm[0] = wishes.gamm[1] = 1.0;
  wishes.no_auto_bright = 1;
  wishes.use_camera_wb = 1;
  wishes.adjust_maximum_thr = 0.0F;  // else white follows the brightest pixel
  // LibRaw itself goes on with what it has, and prints a line.
  bool is_damaged = false;
  raw->set_dataerror_handler([](void* data, const char*, auto) { *static_cast<bool*>(data) = true; },
                             &is_damaged);
  check(raw->open_file(file.c_str()));
  check(raw->unpack());
  if (is_damaged) throw InputError(format("{} cannot be read: it is damaged or was cut off", file.string()));
  if (first_) {
    first_->put(raw->imgdata.color);
    first_->put(raw->imgdata.rawdata.color);  // what developing starts from
  } else {
    first_ = std::make_unique<Levels>(raw->imgdata.color);
  }
  check(raw->dcraw_process());
  int code = LIBRAW_SUCCESS;
  const std::unique_ptr<libraw_processed_image_t, decltype(&LibRaw::dcraw_clear_mem)> image(
      raw->dcraw_make_mem_image(&code), &LibRaw::dcraw_clear_mem);
  check(code);
  const bool is_read = image && image->type == LIBRAW_IMAGE_BITMAP && image->bits == 16 &&
                       (image->colors == 1 || image->colors == 3);
  if (!is_read)
    throw InputError(
        format("{} has {} colours; grey and colour are read", file.string(), image ? image->colors : 0));
  Picture picture({image->width, image->height, image->colors}, ValueType::code16, 65'535);
  std::memcpy(picture.bytes.data(), image->data,
              std::min<std::size_t>(picture.bytes.size(), image->data_size));
  return picture;
}

}  // namespace nutik::stills
