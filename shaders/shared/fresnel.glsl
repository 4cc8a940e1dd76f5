// Unpolarised transmittance from outside into eta. As optics/dipole.h.
float fresnel_transmittance(float eta, float cosine) {
  float c = clamp(cosine, 0.0, 1.0);
  float inside = sqrt(max(0.0, 1.0 - (1.0 - c * c) / (eta * eta)));
  float s = (c - eta * inside) / (c + eta * inside);
  float p = (inside - eta * c) / (inside + eta * c);
  return 1.0 - 0.5 * (s * s + p * p);
}
