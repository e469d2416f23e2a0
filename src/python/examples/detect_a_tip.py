#!/usr/bin/python3
"""Finds the cell and the needle's tip in the virtual microscope's image."""
from cell_microinjection import Session, find_tip, measure_cell


def main():
    with Session('default', 'hand.device:=none', 'injection.mode:=manual', 'camera.source:=sim') as session:
        session.image()
        session.newest('/needle/measured_cp')
        session.run_for(1)
        image = session.image()
        tip = find_tip(image, direction=-1.57)
        print(f"tip: {tip['verdict']}", *(f'{part:.1f}' for part in tip.get('place', ())), 'px')
        cell = measure_cell(image, 0.2e-6)
        print(f'cell: {cell.verdict} {cell.reason}')
        if cell.diameter:
            value, low, high = (1e6 * part for part in cell.diameter)
            print(f'diameter {value:.2f} um, 95 %: {low:.2f} to {high:.2f}')
        height = session.newest('/needle/measured_cp')['pose']['position']['z']
        print(f'the needle is {1e6 * height:.1f} um above the origin, at {session.time:.1f} s of the session')


if __name__ == '__main__':
    main()
