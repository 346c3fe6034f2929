#pragma once

#include <memory>

class vtkRenderWindow;

namespace isorim::io::picture {

/// A window of VTK's that no screen shows, with an OpenGL context made by EGL: needs neither X nor a graphics card
/// (Mesa draws by software then). The context lives as long as the object, and is current on the thread that has made
/// it.
class OffscreenWindow {
 public:
  /// Throws NumericalError, with what to do, if EGL gives no context of OpenGL 3.2.
  OffscreenWindow(int width, int height);
  ~OffscreenWindow();
  OffscreenWindow(const OffscreenWindow&) = delete;
  OffscreenWindow& operator=(const OffscreenWindow&) = delete;

  vtkRenderWindow* get() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace isorim::io::picture
