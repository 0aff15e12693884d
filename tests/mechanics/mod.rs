//! Elements, materials and constraints.

mod beams_side_by_side;
mod coupled_sections;
mod elements;
mod joint_coordinates;
mod joints;
mod materials;
mod offset_masses;
mod profiles;
mod section_polygons;
mod shear_areas;
mod shear_rigid;
mod shells;
mod station_files;
mod stations;
mod superelements;
mod unlimited_rotations;
