// What stands in place of a picture: recent work, and what can be made of a clip.
#pragma once

#include <QIcon>
#include <QWidget>
#include <functional>

class QListWidget;

namespace nutik::studio {

struct StartingPoint;

// The files that were opened last, with small pictures of them, kept in the settings.
struct RecentFile {
  QString path;
  QImage picture;  // null: none yet
};
[[nodiscard]] QList<RecentFile> recent_files();
void remember_file(const QString& path);
void remember_picture(const QString& path, const QImage& picture);

class StartPage : public QWidget {
  Q_OBJECT

 public:
  explicit StartPage(QWidget* parent = nullptr);

 Q_SIGNALS:
  void asked_for_clip();
  void chosen(const QString& path);
  void started(const StartingPoint& point);

 protected:
  void showEvent(QShowEvent* event) override;  // the files are looked up

 private:
  QListWidget* recent_;
};

}  // namespace nutik::studio
