#include "session/making/series_making.hpp"

#include <atomic>
#include <exception>
#include <utility>

#include "session/making/picture_line.hpp"
#include "session/making/picture_queue.hpp"

namespace nutik {

void make_series(Session& session, ExposureRequest exposure, const std::vector<SeriesPicture>& pictures,
                 const OutputFormat& output, const FileWishes& file, const ReportedProgress& progress,
                 const std::function<std::string(std::uint64_t number, ExposedPicture& exposed)>& add) {
  std::atomic<bool> has_failed = false;
  std::exception_ptr failure;
  PictureQueue queue([&](std::size_t, const Error&) {
    if (!has_failed) failure = std::current_exception();
    has_failed = true;
  });
  PictureLine<ExposedPicture> line(session.pictures_at_once(output.type, pictures.size()));
  std::size_t asked = 0;
  for (std::uint64_t k = 0; k < pictures.size() && !has_failed; ++k) {
    if (progress) progress(k, pictures.size());
    for (; asked < pictures.size() && !line.is_full(); ++asked) {
      exposure.start = pictures[asked].start;
      line.add([&, exposure](const RenderControl& control) { return session.render(exposure, output, control); });
    }
    ExposedPicture exposed = line.take();
    std::string text = add ? add(k, exposed) : std::string();
    queue.push(k, pictures[k].path, std::move(exposed.picture), std::move(text), file);
  }
  queue.finish();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace nutik
