// nutik-studio: the window in which functions and masks are drawn while the picture follows.
#include <QApplication>
#include <QMainWindow>

int main(int count, char** words) {
  const QApplication application(count, words);
  QMainWindow window;
  window.show();
  return QApplication::exec();
}
