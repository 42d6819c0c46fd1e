/* Worlds of the class library alone, in space or flat, and bodies of simple shapes in them. */
#ifndef BREVE_TESTS_CAPI_BODIES_H
#define BREVE_TESTS_CAPI_BODIES_H

#include "scene.h"

bool open_bodies(scene* s, bool flat);
bool same_object(breve_object a, breve_object b);

breve_geometry ball_of_radius(double radius);
breve_geometry box_of_size(double x, double y, double z);

/* A body of class "Mobile", "Stationary" or "Link", of that shape, there. */
breve_object add_body(scene* s, const char* class_name, const breve_geometry* geometry, double x, double y, double z);
void put_at(scene* s, breve_object object, double x, double y, double z);
void rotate_about_z(scene* s, breve_object object, double radians);
void set_moving(scene* s, breve_object object, double x, double y, double z);
breve_pose pose_of(scene* s, breve_object object);
uint64_t hash_of_world(scene* s);
void step_times(scene* s, int times);
const breve_effect* effect_of(scene* s, const char* name); /* good until the next call */

/* Numbers that look drawn at random, the same in each run: in [low, high). */
double draw(double low, double high);

#endif
