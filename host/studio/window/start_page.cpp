#include "studio/window/start_page.hpp"

#include <QBuffer>
#include <QCommandLinkButton>
#include <QFileInfo>
#include <QGridLayout>
#include <QImage>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QSettings>
#include <QVBoxLayout>

#include "studio/window/started_work.hpp"

namespace nutik::studio {
namespace {

constexpr const char *kRecentKey = "recent", *kPicturesKey = "recent_pictures";
constexpr int kMaxRecent = 10;
constexpr QSize kPicture(160, 90);

}  // namespace

QList<RecentFile> recent_files() {
  const QVariantMap pictures = QSettings().value(kPicturesKey).toMap();
  QList<RecentFile> files;
  for (const QString& path : QSettings().value(kRecentKey).toStringList())
    files += {path, QImage::fromData(pictures.value(path).toByteArray())};
  return files;
}

void remember_file(const QString& path) {
  QSettings settings;
  QStringList recent = settings.value(kRecentKey).toStringList();
  const QString absolute = QFileInfo(path).absoluteFilePath();
  recent.removeAll(absolute);
  recent.prepend(absolute);
  settings.setValue(kRecentKey, recent.mid(0, kMaxRecent));
}

void remember_picture(const QString& path, const QImage& picture) {
  QSettings settings;
  const QVariantMap before = settings.value(kPicturesKey).toMap();
  QVariantMap pictures;
  for (const RecentFile& file : recent_files())
    if (before.contains(file.path)) pictures[file.path] = before[file.path];
  QByteArray bytes;
  QBuffer buffer(&bytes);
  picture.scaled(2 * kPicture, Qt::KeepAspectRatio, Qt::SmoothTransformation).save(&buffer, "JPG");
  pictures[QFileInfo(path).absoluteFilePath()] = bytes;
  settings.setValue(kPicturesKey, pictures);
}

StartPage::StartPage(QWidget* parent) : QWidget(parent), recent_(new QListWidget(this)) {
  setObjectName("start_page");
  setAutoFillBackground(true);
  auto* open = new QPushButton(tr("Open a clip or a capture…"), this);
  open->setToolTip(tr("Ctrl+O; or drop one here"));
  connect(open, &QPushButton::clicked, this, &StartPage::asked_for_clip);
  auto* cards = new QGridLayout;
  int card = 0;
  for (const StartingPoint& point : starting_points()) {
    auto* button = new QCommandLinkButton(Document::tr(point.name).remove('&'), Document::tr(point.tip), this);
    button->setToolTip(tr("Opens a clip, and makes this of it"));
    connect(button, &QPushButton::clicked, this, [this, &point] { Q_EMIT started(point); });
    cards->addWidget(button, card / 2, card % 2);
    ++card;
  }
  recent_->setObjectName("recent");
  recent_->setAccessibleName(tr("Recent work"));
  recent_->setViewMode(QListView::IconMode);
  recent_->setMovement(QListView::Static);
  recent_->setResizeMode(QListView::Adjust);
  recent_->setIconSize(kPicture);
  recent_->setGridSize(kPicture + QSize(12, 30));
  recent_->setTextElideMode(Qt::ElideMiddle);
  recent_->setFrameShape(QFrame::NoFrame);
  connect(recent_, &QListWidget::itemActivated, this, [this](const QListWidgetItem* item) {
    Q_EMIT chosen(item->toolTip());
  });
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(24, 16, 24, 16);
  column->addWidget(open, 0, Qt::AlignLeft);
  column->addLayout(cards);
  column->addWidget(recent_, 1);
}

void StartPage::showEvent(QShowEvent*) {
  recent_->clear();
  for (const RecentFile& file : recent_files()) {
    if (!QFileInfo::exists(file.path)) continue;
    QPixmap pixmap = QPixmap::fromImage(file.picture);
    if (pixmap.isNull()) {
      pixmap = QPixmap(kPicture);
      pixmap.fill(palette().color(QPalette::Mid));
    }
    auto* item = new QListWidgetItem(QIcon(pixmap), QFileInfo(file.path).fileName(), recent_);
    item->setToolTip(file.path);
  }
}

}  // namespace nutik::studio
