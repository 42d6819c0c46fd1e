// Selectors of Control and Camera.
#include "selectors.hpp"

namespace breve::seeing {

namespace {

#define BALL "thing = ((new Thing) become from ball). self point-camera at (0, 0, 0) from (0, 4, 20). "
#define GROUND BALL "self floor. self enable-lighting. self move-light to (6, 20, 6). "
#define CAUGHT GROUND "land catch-shadows. "
#define CLOUDS "self set-background-texture-image to (self picture of \"clouds\"). "
#define TEXT "self set-display-text to \"Hello\" at-x -.5 at-y 0 with-color (1, 1, 1). "
#define WINDOW \
  BALL "eye = new Camera. eye set-size with-height 50 with-width 60. eye look at (0, 0, 0) from (0, 0, 8). "
#define BLURRED BALL "thing set-velocity to (20, 0, 0). self enable-blur. "
#define SIDES                                                                                                   \
  "{\"images/clouds.png\", \"images/sky.png\", \"images/clouds.png\", \"images/sky.png\", \"images/sky.png\", " \
  "\"images/ground.png\"}"

constexpr Selector kControl[] = {
    {"Control set-background-color", BALL, "self set-background-color to (1, 0, 0)."},
    {"Control set-background-texture-image", BALL, CLOUDS},
    {"Control set-background-texture", BALL,
     "self set-background-texture to ((self picture of \"clouds\") get-texture-number)."},
    {"Control set-background-scroll-rate", BALL CLOUDS, "self set-background-scroll-rate x .1 y .1.", 3},
    {"Control set-skybox-images", BALL, "self set-skybox-images to " SIDES "."},
    {"Control set-mountain-skybox", BALL, "self set-mountain-skybox."},
    {"Control set-shadow-catcher", GROUND, "self set-shadow-catcher. self enable-shadows."},
    {"Control aim-camera", BALL, "self aim-camera at (3, 0, 0)."},
    {"Control set-camera-target", BALL, "self set-camera-target to (3, 0, 0)."},
    {"Control offset-camera", BALL, "self offset-camera by (0, 4, 12)."},
    {"Control set-camera-offset", BALL, "self set-camera-offset to (0, 4, 12)."},
    {"Control point-camera", BALL, "self point-camera at (3, 0, 0) from (0, 4, 12)."},
    {"Control pivot-camera", BALL "thing set-shape to box. ", "self pivot-camera x .3 y .3."},
    {"Control set-camera-rotation", BALL "thing set-shape to box. ", "self set-camera-rotation x .6 y .6."},
    {"Control zoom-camera", BALL, "self zoom-camera to 10."},
    {"Control pan-camera-target", BALL, "self pan-camera-target to (3, 0, 0) steps 3.", 4},
    {"Control pan-camera-offset", BALL, "self pan-camera-offset by (0, 4, 10) steps 3.", 4},
    {"Control bullet-pan-camera-offset", BALL, "self bullet-pan-camera-offset by (0, 4, 10) steps 3.", 4},
    {"Control set-z-clip", BALL, "self set-z-clip to 10."},
    {"Control watch", BALL "other = ((new Thing) become from ball at (6, 0, 0)). ", "self watch item other.", 1},
    {"Control enable-lighting", BALL "self move-light to (0, 20, 0). ", "self enable-lighting."},
    {"Control disable-lighting", GROUND, "self disable-lighting."},
    {"Control toggle-lighting", GROUND, "self toggle-lighting."},
    {"Control move-light", GROUND, "self move-light to (-20, 5, 0)."},
    {"Control set-light-color", GROUND, "self set-light-color to (1, 0, 0)."},
    {"Control set-light-ambient-color", GROUND, "self set-light-ambient-color to (.5, 0, 0)."},
    {"Control set-light-diffuse-color", GROUND, "self set-light-diffuse-color to (1, 0, 0)."},
    {"Control set-light-specular-color", GROUND, "self set-light-specular-color to (1, 1, 1)."},
    {"Control enable-shadows", CAUGHT, "self enable-shadows."},
    {"Control disable-shadows", CAUGHT "self enable-shadows. ", "self disable-shadows."},
    {"Control toggle-shadows", CAUGHT, "self toggle-shadows."},
    {"Control enable-shadow-volumes", CAUGHT, "self enable-shadow-volumes."},
    {"Control disable-shadow-volumes", CAUGHT "self enable-shadow-volumes. ", "self disable-shadow-volumes."},
    {"Control toggle-shadow-volumes", CAUGHT, "self toggle-shadow-volumes."},
    {"Control enable-reflections", CAUGHT, "self enable-reflections."},
    {"Control disable-reflections", CAUGHT "self enable-reflections. ", "self disable-reflections."},
    {"Control toggle-reflections", CAUGHT, "self toggle-reflections."},
    {"Control enable-outline", BALL, "self enable-outline."},
    {"Control disable-outline", BALL "self enable-outline. ", "self disable-outline."},
    {"Control enable-text", BALL TEXT "self disable-text. ", "self enable-text."},
    {"Control disable-text", BALL TEXT, "self disable-text."},
    {"Control set-display-text", BALL, TEXT},
    {"Control set-display-message", BALL, "self set-display-message to \"Hello\" with-number 1 at-x -.5 at-y 0."},
    {"Control set-display-text-scale", BALL TEXT, "self set-display-text-scale to 2."},
    {"Control set-display-text-color", BALL TEXT, "self set-display-text-color to (1, 0, 0)."},
    {"Control enable-blur", BALL "thing set-velocity to (20, 0, 0). ", "self enable-blur.", 3},
    {"Control disable-blur", BLURRED, "self disable-blur.", 3},
    {"Control toggle-blur", BLURRED, "self toggle-blur.", 3},
    {"Control set-blur-factor", BLURRED, "self set-blur-factor to .9.", 3},
    {"Control clear-screen", BLURRED, "self clear-screen.", 3},
    {"Control enable-fog", BALL, "self enable-fog. self set-fog-intensity to 1."},
    {"Control disable-fog", BALL "self enable-fog. self set-fog-intensity to 1. ", "self disable-fog."},
    {"Control toggle-fog", BALL "self set-fog-intensity to 1. ", "self toggle-fog."},
    {"Control set-fog-limits", BALL "self enable-fog. ", "self set-fog-limits with-start 0 with-end 20."},
    {"Control set-fog-intensity", BALL "self enable-fog. ", "self set-fog-intensity to 1."},
    {"Control set-fog-color", BALL "self enable-fog. self set-fog-intensity to 1. ",
     "self set-fog-color to (1, 0, 0)."},
    {"Control enable-light-exposure-drawing", BALL, "self enable-light-exposure-drawing."},
    {"Control disable-light-exposure-drawing", BALL "self enable-light-exposure-drawing. ",
     "self disable-light-exposure-drawing."},
    {"Control set-light-exposure-source", BALL "self enable-light-exposure-drawing. thing set-shape to box. ",
     "self set-light-exposure-source to (9, 5, 9)."},
    {"Camera init", BALL, "eye = new Camera. eye look at (0, 0, 0) from (0, 0, 8)."},
    {"Camera enable-text", WINDOW TEXT "eye disable-text. ", "eye enable-text."},
    {"Camera disable-text", WINDOW TEXT, "eye disable-text."},
    {"Camera watch", WINDOW "other = ((new Thing) become from box at (6, 0, 0)). ", "eye watch item other.", 1},
    {"Camera set-size", WINDOW, "eye set-size with-height 100 with-width 40."},
    {"Camera set-position", WINDOW, "eye set-position with-x 80 with-y 60."},
    {"Camera look", WINDOW, "eye look at (0, 0, 0) from (0, 9, 0)."},
    {"Camera set-z-clip", WINDOW, "eye set-z-clip to 4."},
    {"Camera set-rotation", WINDOW "thing set-shape to box. ", "eye set-rotation x -.7 y .7."},
    {"Camera delete", WINDOW, "free eye."},
};

}  // namespace

std::span<const Selector> control_selectors() { return kControl; }

}  // namespace breve::seeing
