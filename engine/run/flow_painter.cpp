// Nacre: frames of a flow as pictures, with legend, time stamp and axes.
#include "engine/run/flow_painter.hpp"

#include "engine/picture/caption.hpp"
#include "engine/picture/legend.hpp"
#include "engine/run/picture_settings.hpp"
#include "engine/run/skeleton_marks.hpp"
#include "engine/scene/surface/flow_input.hpp"

namespace nacre {

FlowPainter::FlowPainter(FlowPipeline& pipeline, VectorsInTime& input, const Session& session, double frame_time)
    : pipeline_(pipeline),
      input_(input),
      settings_(session.settings),
      frame_time_(frame_time),
      map_(colormap(settings_.colormap)),
      colours_(input.colored() ? shown_colours(settings_, map_, input.color_spread()) : ShownColours()),
      camera_(read_camera(session, corners_of_all_steps(input), settings_.legend && input.colored())) {
  if (settings_.background == "transparent")
    transparent_ = true;
  else
    background_ = parse_color(settings_.background);
}

Image FlowPainter::paint(int frame) {
  const Camera camera = orbit(camera_, settings_.orbit * frame);
  RenderOptions options;
  options.camera = camera;
  options.width = settings_.width;
  options.height = settings_.height;
  options.samples = settings_.samples;
  options.colours = map_.table;
  options.background = background_;
  options.transparent = transparent_;
  options.back_faces = settings_.back_faces;
  std::vector<float> scalar;
  if (input_.colored()) {
    scalar = input_.scalar(pipeline_.flow().time());
    if (part_) scalar = part_->take(scalar);
    scalar = colours_.range.on_axis(scalar);
    options.scalar = scalar;
    options.low = colours_.range.bottom();
    options.high = colours_.range.top();
    options.below = colours_.below;
    options.above = colours_.above;
    options.no_number = colours_.no_number;
  }
  Image image;
  image.width = settings_.width;
  image.height = settings_.height;
  image.pixels = pipeline_.flow().render(options);
  if (dye_) dye_->draw(image, camera);
  const double now = pipeline_.flow().time();
  if (settings_.streamlines)
    draw_streamlines(image, camera, flow_streamlines(input_, now, settings_.line_spacing, nullptr));
  if (!tracks_.tracks.empty()) draw_tracks(image, camera, tracks_, now, input_.shape(now));
  if (settings_.topology) draw_skeleton(image, camera, flow_skeleton(input_, now, settings_.persistence));
  FlowCaption caption;
  caption.map = settings_.legend && input_.colored() ? &map_ : nullptr;
  caption.low = colours_.range.low;
  caption.high = colours_.range.high;
  caption.scale = colours_.scale;
  caption.title = settings_.color == "speed" ? input_.array() : settings_.color;
  if (settings_.time_stamp && input_.end() > input_.start()) caption.time = pipeline_.flow().time();
  caption.frame_time = frame_time_;
  draw_caption(image, caption);
  if (settings_.legend)
    draw_orientation(image, Vec3f(camera.right()), Vec3f(cross(camera.right(), camera.forward())),
                     Vec3f(camera.forward()));
  return image;
}

}  // namespace nacre
