// Tests of the studio: GoogleTest, with QTest driving widgets by mouse and keyboard. Without a screen.
#include <gtest/gtest.h>

#include <QApplication>

int main(int count, char** words) {
  ::testing::InitGoogleTest(&count, words);
  qputenv("QT_QPA_PLATFORM", "offscreen");
  QApplication application(count, words);
  QApplication::setOrganizationName("nutik-tests");
  return RUN_ALL_TESTS();
}
