// nutik-studio: a window in which functions and masks are drawn while the picture follows.
#include <QApplication>
#include <QCommandLineParser>
#include <QIcon>
#include <QLocale>
#include <clocale>
#include <string>

#include "session/devices.hpp"
#include "features/schema/option.hpp"
#include "studio/window/appearance.hpp"
#include "studio/window/main_window.hpp"
#include "system/mapped_file.hpp"
#include "system/own_folders.hpp"

int main(int count, char** words) {
  nutik::prepare_for_pocl();
  nutik::use_own_fonts();
  nutik::watch_mapped_files();  // a capture that somebody cuts off must not end the window
  QApplication application(count, words);
  std::setlocale(LC_NUMERIC, "C");  // of libraries that read and write files; Qt has set it to the person's
  QApplication::setApplicationName("nutik-studio");
  QApplication::setOrganizationName("nutik");
  QApplication::setApplicationVersion(NUTIK_VERSION);
  QApplication::setDesktopFileName("nutik-studio");
  QApplication::setWindowIcon(QIcon::fromTheme("nutik-studio"));  // as it is installed

  QCommandLineParser parser;
  parser.setApplicationDescription("Draw gain functions and masks while the picture follows.");
  parser.addHelpOption();
  parser.addVersionOption();
  const nutik::Option& fps = *nutik::option_of(nutik::CommandId::expose, "fps");
  const auto text = [](std::string_view words) { return QString::fromStdString(std::string(words)); };
  const QCommandLineOption rate({QChar(fps.short_name), text(fps.long_name)}, text(fps.help), text(fps.value));
  parser.addOption(rate);
  parser.addPositionalArgument("file", "A clip, a capture (.tik) or a project (.nutik).",
                               "[CAPTURE.tik|CLIP|PROJECT.nutik]");
  parser.process(application);

  nutik::studio::use_language(QLocale::system().uiLanguages());
  nutik::studio::set_appearance(nutik::studio::kept_appearance());
  nutik::ComputingRequest computing;
  using nutik::studio::MainWindow;
  MainWindow window(computing);
  window.show();
  window.open_first(parser.positionalArguments(), parser.value(rate));
  window.autosave().keep_at_signals();
  return QApplication::exec();
}
