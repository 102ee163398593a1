// From an event of the mouse to the painted picture, and what the window's own thread takes of it:
// nutik_studio_timing CLIP. Five regions, each with a function of its own; then the interval, and a brush that paints
// over what other regions have.
#include <time.h>

#include <QElapsedTimer>
#include <algorithm>
#include <cstdio>
#include <vector>

#include "hand.hpp"
#include "opencl/device.hpp"
#include "studio/curves/curve_editor.hpp"
#include "studio/regions/region_edits.hpp"
#include "studio/time/time_strip.hpp"
#include "studio/window/appearance.hpp"
#include "studio/window/main_window.hpp"

using namespace nutik::studio;

namespace {

constexpr int kEvents = 120, kRegions = 5, kTurn = 30;  // events to a side

double thread_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

void tell(const char* what, std::vector<double> values) {
  std::ranges::sort(values);
  std::printf("%-44s median %6.1f ms, 95th percentile %6.1f ms\n", what, values[values.size() / 2],
              values[values.size() * 95 / 100]);
}

// Drags to and fro, each move once the picture of the one before is painted.
void drag(MainWindow& window, QWidget& widget, QPoint from, const char* what, int step = 1,
          int events = kEvents) {
  std::vector<double> whole, own;
  QTest::mousePress(&widget, Qt::LeftButton, Qt::ControlModifier, from);
  for (int event = 1; event <= events; ++event) {
    const QPoint to = from + step * QPoint(kTurn - std::abs(kTurn - event % (2 * kTurn)), 0);
    QElapsedTimer timer;
    timer.start();
    const double begin = thread_ms();
    move_pressed(widget, to, Qt::ControlModifier);
    while (!window.is_settled()) QCoreApplication::processEvents(QEventLoop::WaitForMoreEvents);
    QCoreApplication::processEvents();
    own.push_back(thread_ms() - begin);
    whole.push_back(static_cast<double>(timer.nsecsElapsed()) * 1e-6);
  }
  QTest::mouseRelease(&widget, Qt::LeftButton, Qt::ControlModifier, from);
  tell(what, whole);
  tell("  of that the window's own thread", own);
}

}  // namespace

int main(int count, char** words) {
  nutik::prepare_for_pocl();  // as the program does
  qputenv("QT_QPA_PLATFORM", "offscreen");
  QApplication application(count, words);
  if (count < 2) {
    std::fputs("nutik_studio_timing CLIP\n", stderr);
    return 2;
  }
  set_appearance(Appearance::dark);
  MainWindow window;
  window.resize(1920, 1200);
  window.show();
  const auto settles = [&] { return QTest::qWaitFor([&] { return window.is_settled(); }, 300'000); };
  window.open(QString::fromLocal8Bit(words[1]));
  if (!settles() || window.document().facts() == nullptr) return 1;
  window.canvas().show_actual_size();
  Document& document = window.document();
  const nutik::Shape shape = document.facts()->format.shape;
  const std::int64_t duration_ns = document.duration_ns();
  for (int region = 1; region <= kRegions; ++region) {
    if (region > 1) add_region(document);
    const double width = 1.0 * shape.width / kRegions;
    paint_region(document,
                 nutik::rectangle(shape.width, shape.height, {width * (region - 1), 0}, width, shape.height),
                 document.selected_tag(), "Band");
    document.set_points(document.selected_tag(),
                        {{0, 0.0}, {duration_ns / 2 + region, 1.0}, {duration_ns, 0.2}}, "Ramp");
  }
  if (!settles()) return 1;
  auto& curves = *window.findChild<CurveEditor*>("curves");
  const auto points = document.points(document.selected_tag());
  drag(window, curves, curves.frame().place(points[1]).toPoint(),
       "a control point between the capture's ends");
  auto& strip = *window.findChild<TimeStrip*>("time_strip");
  document.set_boxcar({duration_ns / 3, 10'000'000}, "Scrub");
  if (!settles()) return 1;
  drag(window, strip, strip.boxcar_area().center().toPoint(), "an interval of 10 ms");
  document.set_mode(ExposureMode::functions);
  window.use_tool(ToolKind::brush);
  if (!settles()) return 1;
  for (const std::uint8_t tag : {document.state().order.front(), document.state().order.back()}) {
    document.select_tag(tag);
    const bool is_first = tag == document.state().order.front();
    drag(window, window.canvas(),
         window.canvas().view().to_widget({shape.width * 0.3, shape.height * 0.5}).toPoint(),
         is_first ? "a brush over three regions" : "a brush beneath three regions", 16, kTurn);
  }
  window.use_tool(ToolKind::look);
  window.canvas().fit();
  if (!settles()) return 1;
  drag(window, curves, curves.frame().place(points[1]).toPoint(), "a control point, the whole picture in sight");
  DocumentState plain = document.state();
  plain.mask.reset();
  std::erase_if(plain.functions, [](const auto& function) { return function.first != 0; });
  document.apply(std::move(plain), "Background alone");
  document.set_points(0, {{0, 0.0}, {duration_ns / 2, 1.0}, {duration_ns, 0.2}}, "Ramp");
  if (!settles()) return 1;
  for (const char* what : {"a control point of all of the picture", "the same, pixel for pixel"}) {
    drag(window, curves, curves.frame().place(document.points(0)[1]).toPoint(), what, 1, kTurn);
    window.canvas().show_actual_size();
    if (!settles()) return 1;
  }
  return 0;
}
