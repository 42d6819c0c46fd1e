// Selectors of Real and its descendants, and of MultiBody.
#include "selectors.hpp"

namespace breve::seeing {

namespace {

#define BALL "thing = ((new Thing) become from ball). self point-camera at (0, 0, 0) from (0, 4, 20). "
#define CUBE "thing = ((new Thing) become from box). self point-camera at (0, 0, 0) from (6, 6, 14). "
#define PAIR BALL "other = ((new Thing) become from ball at (5, 0, 0) in (0, 1, 0)). "
#define SHADED \
  BALL "self floor. land catch-shadows. self enable-lighting. self enable-shadows. self move-light to (6, 20, 6). "
#define TEXTURED CUBE "thing set-texture-image to (self picture of \"checker\"). "
#define SPRITE BALL "thing set-bitmap-image to (self picture of \"star\"). "
#define ARM                                                                                                        \
  "thing = new Link. thing set-shape to box. body = new MultiBody. body set-root to thing. body disable-physics. " \
  "self point-camera at (0, 0, 0) from (6, 6, 14). "
#define HILLS                                                                 \
  "land = new Terrain. land generate with-height 8. land move to (0, 0, 0). " \
  "self point-camera at (0, 0, 0) from (0, 30, 60). "
#define MARK "self picture of \"checker\""

constexpr Selector kBodies[] = {
    {"Real move", BALL, "thing move to (2, 0, 0)."},
    {"Real set-shape", BALL, "thing set-shape to box."},
    {"Real set-display-shape", BALL, "thing set-display-shape to box."},
    {"Real set-rotation", CUBE, "thing set-rotation around-axis (0, 1, 0) by .5."},
    {"Real point", CUBE, "thing point vertex (0, 1, 0) at (1, 1, 0)."},
    {"Real set-color", BALL, "thing set-color to (0, 0, 1)."},
    {"Real set-transparency", BALL, "thing set-transparency to .3."},
    {"Real make-invisible", BALL, "thing make-invisible."},
    {"Real make-visible", BALL "thing make-invisible. ", "thing make-visible."},
    {"Real show-bounding-box", BALL, "thing show-bounding-box."},
    {"Real hide-bounding-box", BALL "thing show-bounding-box. ", "thing hide-bounding-box."},
    {"Real show-axis", BALL, "thing show-axis."},
    {"Real hide-axis", BALL "thing show-axis. ", "thing hide-axis."},
    {"Real show-neighbor-lines", PAIR "thing set-neighborhood-size to 9. ",
     "self update-neighbors. thing show-neighbor-lines."},
    {"Real hide-neighbor-lines",
     PAIR "thing set-neighborhood-size to 9. self update-neighbors. thing show-neighbor-lines. ",
     "thing hide-neighbor-lines."},
    {"Real add-line", PAIR, "thing add-line to other with-color (1, 0, 0)."},
    {"Real add-dotted-line", PAIR, "thing add-dotted-line to other with-color (1, 0, 0)."},
    {"Real remove-line", PAIR "thing add-line to other with-color (1, 0, 0). ", "thing remove-line to other."},
    {"Real remove-all-lines", PAIR "thing add-line to other with-color (1, 0, 0). ", "thing remove-all-lines."},
    {"Real enable-shadows", SHADED "thing disable-shadows. ", "thing enable-shadows."},
    {"Real disable-shadows", SHADED, "thing disable-shadows."},
    {"Real set-texture-image", CUBE, "thing set-texture-image to (" MARK "). thing set-texture-scale to 3."},
    {"Real set-texture-scale", TEXTURED, "thing set-texture-scale to 3."},
    {"Real set-texture-scale-x", TEXTURED, "thing set-texture-scale-x to 3."},
    {"Real set-texture-scale-y", TEXTURED, "thing set-texture-scale-y to 3."},
    {"Real draw-as-point", BALL, "thing draw-as-point."},
    {"Real set-bitmap-image", BALL, "thing set-bitmap-image to (self picture of \"star\")."},
    {"Real set-bitmap-heading", SPRITE, "thing set-bitmap-heading to .785."},
    {"Real set-bitmap-heading-point", SPRITE, "thing set-bitmap-heading-point towards-vector (1, 1, 0)."},
    {"Real set-lightmap-image", BALL, "thing set-lightmap-image to (self picture of \"star\")."},
    {"Real set-lightmap", BALL, "thing set-lightmap to ((self picture of \"star\") get-texture-number)."},
    {"Mobile set-label", BALL, "thing set-label to \"a ball\"."},
    {"Mobile remove-label", BALL "thing set-label to \"a ball\". ", "thing remove-label."},
    {"Mobile rotate", CUBE, "thing rotate around-axis (0, 1, 0) by .5."},
    {"Stationary catch-shadows", BALL "self floor. self enable-lighting. self move-light to (6, 20, 6). ",
     "land catch-shadows. self enable-shadows."},
    {"Floor set-size", BALL "land = new Floor. land move to (0, -5, 0). ", "land set-size to (6, 5, 6)."},
    {"Shape scale", BALL, "ball scale by (.5, .5, .5)."},
    {"Shape set-scale", CUBE, "box set-scale to (1, 2, 1)."},
    {"Shape init-with-polygon-disk", BALL,
     "thing set-shape to ((new Shape) init-with-polygon-disk sides 5 height 1 radius 2)."},
    {"Shape init-with-polygon-cone", BALL,
     "thing set-shape to ((new Shape) init-with-polygon-cone sides 5 height 3 radius 2)."},
    {"MultiBody set-color", ARM, "body set-color to (1, 0, 0)."},
    {"MultiBody set-texture-image", ARM, "body set-texture-image to (" MARK "). body set-texture-scale to 3."},
    {"MultiBody set-texture-scale", ARM "body set-texture-image to (" MARK "). ", "body set-texture-scale to 3."},
    {"MultiBody rotate", ARM, "body rotate around-axis (0, 1, 0) by .5."},
    {"MultiBody move", ARM, "body move to (1, 0, 0)."},
    {"MultiBody show-axis", ARM, "body show-axis."},
    {"MultiBody hide-axis", ARM "body show-axis. ", "body hide-axis."},
    {"MultiBody show-bounding-box", ARM, "body show-bounding-box."},
    {"MultiBody hide-bounding-box", ARM "body show-bounding-box. ", "body hide-bounding-box."},
    {"Terrain generate", "land = new Terrain. self point-camera at (0, 0, 0) from (0, 30, 60). ",
     "land generate with-height 8."},
    {"Terrain set-scale", HILLS, "land set-scale to .5."},
    {"Terrain set-height", HILLS, "for n = 20, n < 40, n++: land set-height at-x n at-y 30 to 12."},
    {"Terrain set-peak-color", HILLS, "land set-peak-color to (1, 0, 0)."},
    {"Terrain set-valley-color", HILLS, "land set-valley-color to (1, 0, 0)."},
    {"Terrain set-color", HILLS, "land set-color to (1, 0, 0)."},
    {"Terrain move", HILLS, "land move to (10, 0, 0)."},
    {"Terrain draw-wireframe", HILLS, "land draw-wireframe."},
    {"Terrain draw-solid", HILLS "land draw-wireframe. ", "land draw-solid."},
};

}  // namespace

std::span<const Selector> body_selectors() { return kBodies; }

}  // namespace breve::seeing
