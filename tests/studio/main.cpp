// Tests of the studio: GoogleTest, with QTest driving widgets by mouse and keyboard. Without a screen, and with settings
// and unsaved work of their own, since several run at a time.
#include <gtest/gtest.h>

#include <QApplication>
#include <QTemporaryDir>

#include "opencl/device.hpp"

int main(int count, char** words) {
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
