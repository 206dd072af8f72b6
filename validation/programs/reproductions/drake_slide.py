"""A sled under the load of a slope of tangent 1, mu = 0.5: the largest height that it rises to, over the slip of its last step."""

import pydrake.all as d

for kind in "sap", "similar":
    plant, _ = d.AddMultibodyPlant(d.MultibodyPlantConfig(time_step=0.001, contact_model="point", discrete_contact_approximation=kind), builder := d.DiagramBuilder())
    feet = "".join(f'<geom pos="{x} {y} -.01" size=".01" friction=".5"/>' for x in (-0.1, 0.1) for y in (-0.1, 0.1))
    d.Parser(plant).AddModelsFromString(f"""<mujoco model="m"><worldbody><geom type="plane" size="1 1 1" friction=".5"/><body name="sled"
      pos="0 0 .02"><freejoint/>{feet}<inertial mass=".3" pos="0 0 0" diaginertia="1e-3 1e-3 2e-3"/></body></worldbody></mujoco>""", "xml")
    simulator = d.Simulator(plant.Finalize() or builder.Build())
    z = []
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    simulator.AdvanceTo(0.5)
    plant.get_applied_generalized_force_input_port().FixValue(context, [0, 0, 0, 2.0810, 0, 0.86198])  # 0.3 9.81 (sin a, 0, 1 - cos a)
    for k in range(500):
        z += [simulator.AdvanceTo(0.501 + 0.001 * k) and plant.GetPositions(context)[6]]
    print(f"point, {kind}: {(max(z) - 0.02) / (0.001 * plant.GetVelocities(context)[3]):.3g} of the slip of a step (Coulomb: 0)")
