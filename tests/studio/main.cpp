// Tests of the studio: GoogleTest, with QTest driving widgets by mouse and keyboard. Without a screen, and with
// settings and unsaved work of their own, since several run at a time.
#include <gtest/gtest.h>

#include <QApplication>
#include <QTemporaryDir>
#include <string_view>

#include "opencl/device.hpp"

namespace nutik::studio {
int save_changed(const char* project);  // project_file_test.cpp
}

int main(int count, char** words) {
  if (count == 3 && std::string_view(words[1]) == "--save") return nutik::studio::save_changed(words[2]);
  nutik::prepare_for_pocl();
  ::testing::InitGoogleTest(&count, words);
  qputenv("QT_QPA_PLATFORM", "offscreen");
  qputenv("NUTIK_MODULES", NUTIK_TEST_MODULES);
  const QTemporaryDir home;
  for (const char* folder : {"XDG_CONFIG_HOME", "XDG_DATA_HOME"}) qputenv(folder, home.path().toLocal8Bit());
  QApplication application(count, words);
  QApplication::setOrganizationName("nutik-tests");
  return RUN_ALL_TESTS();
}
