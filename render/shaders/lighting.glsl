// The light of every scene: a warm sun from the upper side and a sky that is bluish above and
// brownish below. Chosen by taste, so that a white surface that faces the sun stays just below 1.
const vec3 sun_direction = vec3(0.4243, 0.7576, 0.4960); // towards the sun, unit length
const vec3 sun_color = vec3(0.70, 0.66, 0.58);
const vec3 sky_ambient = vec3(0.26, 0.30, 0.37);
const vec3 ground_ambient = vec3(0.17, 0.15, 0.12);

// Lambert sun plus hemisphere ambient for a unit normal in world space.
vec3 light_of(vec3 normal)
{
    float up = normal.y * 0.5 + 0.5;
    return mix(ground_ambient, sky_ambient, up) +
           sun_color * max(dot(normal, sun_direction), 0.0);
}
