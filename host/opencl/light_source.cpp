#include "opencl/light_source.hpp"

#include <utility>

#include "opencl/light_curve.hpp"
#include "opencl/light_pieces.hpp"

namespace nutik {

LightSource light_source(const CaptureFormat& capture, Precision precision, bool permutes_pieces) {
  if (capture.transfer.is_linear()) return {"NUTIK_LIGHT_LINEAR", {}};
  if (precision == Precision::single_) {
    if (permutes_pieces) {
      if (auto pieces = light_pieces(capture.transfer, capture.white_code)) {
        return {"NUTIK_LIGHT_PIECES", std::move(*pieces)};
      }
    }
    if (auto curve = light_curve(capture.transfer, capture.white_code)) {
      return {"NUTIK_LIGHT_CURVE", std::move(*curve)};
    }
  }
  return {"NUTIK_LIGHT_TABLE", capture.transfer.light_of_all_codes(capture.white_code, capture.code_bytes)};
}

}  // namespace nutik
