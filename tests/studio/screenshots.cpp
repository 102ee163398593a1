// Takes the pictures of docs/how-to/studio.md: nutik_studio_screenshots CLIP FOLDER.
#include <QApplication>
#include <QDir>
#include <QElapsedTimer>
#include <QTest>
#include <cstdio>

#include "studio/regions/region_edits.hpp"
#include "studio/window/appearance.hpp"
#include "studio/window/main_window.hpp"

using namespace nutik::studio;

int main(int count, char** words) {
  qputenv("QT_QPA_PLATFORM", "offscreen");
  QApplication application(count, words);
  QApplication::setOrganizationName("nutik-tests");
  QApplication::setApplicationName("screenshots");
  const QStringList arguments = QApplication::arguments();
  if (arguments.size() < 3) {
    std::fputs("nutik_studio_screenshots CLIP FOLDER\n", stderr);
    return 2;
  }
  const QDir folder(arguments[2]);
  set_appearance(Appearance::dark);
  MainWindow window;
  window.show();
  const auto settles = [&] { return QTest::qWaitFor([&] { return window.is_settled(); }, 300'000); };
  const auto take = [&](const char* name) { return settles() && (QApplication::processEvents(), true) && window.grab().save(folder.filePath(name)); };
  if (!take("empty.png")) return 1;
  window.open(arguments[1]);
  if (!take("interval.png")) return 1;
  window.start_study(nutik::StudyStyle::trail);
  if (!settles()) return 1;
  const QRect picture({0, 0}, window.canvas().image().size());
  window.document().set_probe(picture.center());
  if (!window.document().functions().empty()) window.document().select_tag(window.document().functions().rbegin()->first);
  if (!take("studio.png")) return 1;
  set_appearance(Appearance::light);
  if (!take("light.png")) return 1;
  set_appearance(Appearance::dark);
  window.resize(2560, 1600);
  window.use_tool(ToolKind::brush);
  return take("large.png") ? 0 : 1;
}
