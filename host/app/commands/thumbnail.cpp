#include <array>

#include "app/output/output_name.hpp"
#include "app/output/report.hpp"
#include "capture/format.hpp"
#include "capture/picture.hpp"
#include "features/schema/options.hpp"
#include "media/writers/picture_writer.hpp"
#include "session/session.hpp"
#include "session/text/number_text.hpp"
#include "sheet/drawings.hpp"
#include "tik/reader.hpp"

namespace nutik::app {

int run_thumbnail(const Options& options) {
  const std::filesystem::path output = output_name(options, "thumbnail", "-thumbnail.png");
  const std::uint32_t side = options.width.value_or(256);
  const std::string& name = options.operands.front();
  check_picture_output(output, /*channels=*/3, std::array{name}, replacing(options));
  const CaptureFormat capture = tik::Reader(name).format();  // refuses a clip, which would be read to its end

  // Without a device: file managers ask for one picture at a time, and shut programs off from caches and drivers.
  SourceRequest source;
  source.path = name;
  ComputingRequest computing;
  computing.renderer = RendererKind::reference;
  Session session(source, computing);
  ExposureRequest request;
  request.gains = PlainInterval{StatedTime::of_pictures(1), Shutter()};
  const ExposedPicture first =
      session.render(request, {ValueType::code8, 255, NegativeLight::saturate, Transfer::srgb()});
  const Picture small = sheet::fitted_thumbnail(first.picture, capture.shown_shape(), side);
  write_picture(output, small);

  Answer answer{{{"picture", output.string()}}};
  answer.json.update(shape_json(small.shape));
  answer.line = format("{}: {}", output.string(), shape_text(small.shape));
  return tell(options, output, answer);
}

}  // namespace nutik::app
