// Tests of the studio: GoogleTest, with QTest driving widgets by mouse and keyboard. Without a screen.
#include <gtest/gtest.h>

#include <QApplication>
#include <QStandardPaths>

int main(int count, char** words) {
  ::testing::InitGoogleTest(&count, words);
  qputenv("QT_QPA_PLATFORM", "offscreen");
  qputenv("NUTIK_MODULES", NUTIK_TEST_MODULES);
  QApplication application(count, words);
  QApplication::setOrganizationName("nutik-tests");
  QStandardPaths::setTestModeEnabled(true);
  return RUN_ALL_TESTS();
}
