// Binding points and attribute locations; C++ reads this file too.
#define ATTRIBUTE_POSITION 0
#define ATTRIBUTE_NORMAL 1
#define ATTRIBUTE_RADIOSITY 2
#define ATTRIBUTE_IRRADIANCE 3
#define ATTRIBUTE_TEXTURE_COORDINATE 4
#define ATTRIBUTE_COLOR 5

#define UNIT_GBUFFER_POSITION 0
#define UNIT_GBUFFER_NORMAL 1
#define UNIT_ATLAS_IRRADIANCE 2
#define UNIT_ATLAS_SURFACE 3
#define UNIT_GBUFFER_IRRADIANCE 4
#define UNIT_GBUFFER_ALBEDO 5
#define UNIT_ALBEDO 6
#define UNIT_NORMAL 7
#define UNIT_ROUGHNESS 8

#define UNIFORMS_VIEW 0
#define UNIFORMS_MATERIAL 1
#define UNIFORMS_BOX 2
#define UNIFORMS_PAPER 3

#define STORAGE_LIGHTS 0

// Where passes that make extra channels leave what they make.
#define TARGET_RADIANCE 0
#define TARGET_IRRADIANCE 1
#define TARGET_RADIOSITY 2

// Of the G-buffer.
#define TARGET_POSITION 0
#define TARGET_NORMAL 1
#define TARGET_ENTERING 2
#define TARGET_ALBEDO 3
#define TARGET_COAT 4

#define TERM_LOCAL 1
#define TERM_GLOBAL 2
